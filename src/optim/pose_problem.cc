// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_problem.h"

#include <limits>

#include "optim/robust.h"

namespace hullslam::internal {
namespace {

double Chi2(const PinholeCamera& camera, const PoseObservation& observation,
            const Rigid3& cam_from_world) {
  return PointChi2(camera, observation.measurement, cam_from_world * observation.point);
}

}  // namespace

double PointTerms::Cost(const Rigid3& pose) const {
  double cost = 0.0;
  for (size_t i = 0; i < observations_.size(); ++i) {
    if (is_inlier_[i] != 0) {
      const double chi2 = Chi2(camera_, observations_[i], pose);
      cost += robust_ ? HuberCost(chi2, OutlierBound(observations_[i].measurement)) : chi2;
    }
  }
  return cost;
}

void PointTerms::Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const {
  hessian.setZero();
  gradient.setZero();
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  for (size_t i = 0; i < observations_.size(); ++i) {
    const PoseObservation& observation = observations_[i];
    const Eigen::Vector3d point_in_cam = rotation * observation.point + pose.translation;
    if (is_inlier_[i] == 0 || point_in_cam.z() < kMinDepth) {
      continue;
    }
    const PointMeasurement& measurement = observation.measurement;
    const Eigen::Vector3d residual = PointResidual(camera_, measurement, point_in_cam);
    const Eigen::Matrix3d by_point = PointResidualJacobian(camera_, measurement, point_in_cam);
    const double weight =
        robust_ ? HuberWeight(residual.squaredNorm(), OutlierBound(measurement)) : 1.0;
    Eigen::Matrix<double, 3, 6> by_pose;
    by_pose.leftCols<3>() = -by_point * Skew(point_in_cam);
    by_pose.rightCols<3>() = by_point;
    hessian.noalias() += weight * by_pose.transpose() * by_pose;
    gradient.noalias() += weight * by_pose.transpose() * residual;
  }
}

void ChooseInliers(const PinholeCamera& camera, std::span<const PoseObservation> observations,
                   InlierRule rule, PoseOptimizationResult& result) {
  result.inlier_count = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    const double bound = rule == InlierRule::kBelowBound ? OutlierBound(observations[i].measurement)
                                                         : std::numeric_limits<double>::max();
    const bool is_inlier = Chi2(camera, observations[i], result.cam_from_world) <= bound;
    result.is_inlier[i] = is_inlier ? 1 : 0;
    result.inlier_count += is_inlier ? 1 : 0;
  }
}

}  // namespace hullslam::internal
