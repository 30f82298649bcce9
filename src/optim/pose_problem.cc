// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_problem.h"

#include <limits>

#include "optim/robust.h"

namespace hullslam::internal {
namespace {

// A pose whose rotation is a matrix, because it moves many points.
struct MatrixPose {
  explicit MatrixPose(const Rigid3& pose)
      : rotation(pose.rotation.toRotationMatrix()), translation(pose.translation) {}

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }

  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
};

double Chi2(const PinholeCamera& camera, const PoseObservation& observation,
            const MatrixPose& cam_from_world) {
  return PointChi2(camera, observation.measurement, cam_from_world * observation.point);
}

}  // namespace

double PointTerms::Cost(const Rigid3& pose) const {
  const MatrixPose cam_from_world(pose);
  double cost = 0.0;
  for (size_t i = 0; i < observations_.size(); ++i) {
    if (is_inlier_[i] != 0) {
      const double chi2 = Chi2(camera_, observations_[i], cam_from_world);
      cost += robust_ ? HuberCost(chi2, OutlierBound(observations_[i].measurement)) : chi2;
    }
  }
  return cost;
}

void PointTerms::Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const {
  // A step (w, v) of the pose moves a point x of the camera frame by -[x]_x w + v. So the parts of
  // hessian and gradient follow from those by the point, H and g: -[x]_x H [x]_x, -H [x]_x, H; and
  // x x g, g. Only sums of 3x3 matrices are needed.
  Eigen::Matrix3d by_rotation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_translation = Eigen::Matrix3d::Zero();
  gradient.setZero();
  const MatrixPose cam_from_world(pose);
  for (size_t i = 0; i < observations_.size(); ++i) {
    const PoseObservation& observation = observations_[i];
    const Eigen::Vector3d point_in_cam = cam_from_world * observation.point;
    if (is_inlier_[i] == 0 || point_in_cam.z() < kMinDepth) {
      continue;
    }
    const PointMeasurement& measurement = observation.measurement;
    const Eigen::Vector3d residual = PointResidual(camera_, measurement, point_in_cam);
    const Eigen::Matrix3d by_point = PointResidualJacobian(camera_, measurement, point_in_cam);
    const double weight =
        robust_ ? HuberWeight(residual.squaredNorm(), OutlierBound(measurement)) : 1.0;
    Eigen::Matrix3d point_hessian;
    point_hessian.noalias() = by_point.transpose() * (weight * by_point);
    Eigen::Vector3d point_gradient;
    point_gradient.noalias() = by_point.transpose() * (weight * residual);
    // [x]_x H, column by column; H is symmetric, so its transpose is -H [x]_x.
    Eigen::Matrix3d skew_hessian;
    for (int column = 0; column < 3; ++column) {
      skew_hessian.col(column) = point_in_cam.cross(point_hessian.col(column));
    }
    mixed += skew_hessian;
    // -[x]_x H [x]_x, row by row.
    for (int row = 0; row < 3; ++row) {
      by_rotation.col(row) += point_in_cam.cross(skew_hessian.row(row).transpose());
    }
    by_translation += point_hessian;
    gradient.head<3>() += point_in_cam.cross(point_gradient);
    gradient.tail<3>() += point_gradient;
  }
  hessian << by_rotation, mixed, mixed.transpose(), by_translation;
}

void ChooseInliers(const PinholeCamera& camera, std::span<const PoseObservation> observations,
                   InlierRule rule, PoseOptimizationResult& result) {
  const MatrixPose cam_from_world(result.cam_from_world);
  result.inlier_count = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    const double bound = rule == InlierRule::kBelowBound ? OutlierBound(observations[i].measurement)
                                                         : std::numeric_limits<double>::max();
    const bool is_inlier = Chi2(camera, observations[i], cam_from_world) <= bound;
    result.is_inlier[i] = is_inlier ? 1 : 0;
    result.inlier_count += is_inlier ? 1 : 0;
  }
}

}  // namespace hullslam::internal
