// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_problem.h"

#include <Eigen/Geometry>
#include <limits>

#include "geometry/matrix_pose.h"
#include "optim/robust.h"

namespace hullslam::internal {
namespace {

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
  // A step (w, v) of the pose moves a point x of the camera frame by -[x]_x w + v. So if H and g
  // are the Hessian and the gradient by x, those by (w, v) have the parts -[x]_x H [x]_x, [x]_x H
  // and H, and the parts [x]_x g and g. Only 3x3 matrices are summed up.
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
    const PointLinearization linear(camera_, observation.measurement, point_in_cam);
    const double weight =
        robust_ ? HuberWeight(linear.residual.squaredNorm(), OutlierBound(observation.measurement))
                : 1.0;
    const Eigen::Matrix3d point_hessian = weight * linear.Hessian();
    const Eigen::Vector3d point_gradient = weight * linear.Gradient();
    const Eigen::Matrix3d skew = Skew(point_in_cam);
    const Eigen::Matrix3d skew_hessian = skew * point_hessian;
    by_rotation -= skew_hessian * skew;
    mixed += skew_hessian;
    by_translation += point_hessian;
    gradient.head<3>() += point_in_cam.cross(point_gradient);
    gradient.tail<3>() += point_gradient;
  }
  hessian << by_rotation, mixed, mixed.transpose(), by_translation;
}

bool ChooseInliers(const PinholeCamera& camera, std::span<const PoseObservation> observations,
                   InlierRule rule, PoseOptimizationResult& result) {
  const MatrixPose cam_from_world(result.cam_from_world);
  result.inlier_count = 0;
  bool has_changed = false;
  for (size_t i = 0; i < observations.size(); ++i) {
    const double bound = rule == InlierRule::kBelowBound ? OutlierBound(observations[i].measurement)
                                                         : std::numeric_limits<double>::max();
    const bool is_inlier = Chi2(camera, observations[i], cam_from_world) <= bound;
    has_changed |= is_inlier != (result.is_inlier[i] != 0);
    result.is_inlier[i] = is_inlier ? 1 : 0;
    result.inlier_count += is_inlier ? 1 : 0;
  }
  return has_changed;
}

}  // namespace hullslam::internal
