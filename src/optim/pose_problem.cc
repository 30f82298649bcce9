// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_problem.h"

#include <cmath>
#include <limits>

#include "optim/robust.h"

namespace hullslam::internal {
namespace {

constexpr double kMinDepth = 1e-3;  // m

// In u, v and the virtual right coordinate, u less the disparity.
Eigen::Vector3d Residual(const PinholeCamera& camera, const PoseObservation& observation,
                         const Eigen::Vector3d& point_in_cam) {
  Eigen::Vector3d residual = ProjectRgbd(camera, point_in_cam) - observation.measured;
  residual.z() = observation.has_depth ? residual.x() - residual.z() : 0.0;
  return residual;
}

// Squared error in sigmas; infinite behind the camera.
double Chi2(const PinholeCamera& camera, const PoseObservation& observation,
            const Rigid3& cam_from_world) {
  const Eigen::Vector3d point_in_cam = cam_from_world * observation.point;
  if (point_in_cam.z() < kMinDepth) {
    return std::numeric_limits<double>::infinity();
  }
  return observation.inverse_sigma2 * Residual(camera, observation, point_in_cam).squaredNorm();
}

double HuberCost(double chi2, double bound) {
  return chi2 <= bound ? chi2 : 2.0 * std::sqrt(bound * chi2) - bound;
}

}  // namespace

double Bound(const PoseObservation& observation) {
  return observation.has_depth ? kChi2Rgbd : kChi2Mono;
}

double PointTerms::Cost(const Rigid3& pose) const {
  double cost = 0.0;
  for (size_t i = 0; i < observations_.size(); ++i) {
    if (is_inlier_[i] != 0) {
      const double chi2 = Chi2(camera_, observations_[i], pose);
      cost += robust_ ? HuberCost(chi2, Bound(observations_[i])) : chi2;
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
    const Eigen::Vector3d residual = Residual(camera_, observation, point_in_cam);
    Eigen::Matrix3d by_point = ProjectRgbdJacobian(camera_, point_in_cam);
    by_point.row(2) = observation.has_depth ? by_point.row(0) - by_point.row(2)
                                            : Eigen::RowVector3d::Zero().eval();
    double weight = observation.inverse_sigma2;
    if (robust_) {
      weight *= HuberWeight(weight * residual.squaredNorm(), Bound(observation));
    }
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
    const double bound = rule == InlierRule::kBelowBound ? Bound(observations[i])
                                                         : std::numeric_limits<double>::max();
    const bool is_inlier = Chi2(camera, observations[i], result.cam_from_world) <= bound;
    result.is_inlier[i] = is_inlier ? 1 : 0;
    result.inlier_count += is_inlier ? 1 : 0;
  }
}

}  // namespace hullslam::internal
