// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/optim/pose_optimization.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "hullslam/costs/projection.h"
#include "hullslam/map/intrinsics.h"
#include "hullslam/optim/robust.h"

namespace hullslam {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kMinDepth = 1e-3;  // m

double Bound(const PoseObservation& observation) {
  return observation.has_depth ? kChi2Rgbd : kChi2Mono;
}

Eigen::Vector3d Residual(const Intrinsics& camera, const PoseObservation& observation,
                         const Eigen::Vector3d& point_in_cam) {
  Eigen::Vector3d residual = ProjectRgbd(camera, point_in_cam) - observation.measured;
  if (!observation.has_depth) {
    residual.z() = 0.0;
  }
  return residual;
}

// Squared error in sigmas; infinite behind the camera.
double Chi2(const Intrinsics& camera, const PoseObservation& observation,
            const Rigid3& cam_from_world) {
  const Eigen::Vector3d point_in_cam = cam_from_world * observation.point;
  if (point_in_cam.z() < kMinDepth) {
    return std::numeric_limits<double>::infinity();
  }
  return observation.inverse_sigma2 * Residual(camera, observation, point_in_cam).squaredNorm();
}

// One robust least-squares problem over the inliers.
class PoseProblem {
 public:
  PoseProblem(const Intrinsics& camera, std::span<const PoseObservation> observations,
              const std::vector<uint8_t>& is_inlier, bool robust)
      : camera_(camera), observations_(observations), is_inlier_(is_inlier), robust_(robust) {}

  double Cost(const Rigid3& pose) const {
    double cost = 0.0;
    for (size_t i = 0; i < observations_.size(); ++i) {
      if (is_inlier_[i] != 0) {
        const double chi2 = Chi2(camera_, observations_[i], pose);
        cost += robust_ ? HuberCost(chi2, Bound(observations_[i])) : chi2;
      }
    }
    return cost;
  }

  void Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const {
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
      if (!observation.has_depth) {
        by_point.row(2).setZero();
      }
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

 private:
  static double HuberCost(double chi2, double bound) {
    return chi2 <= bound ? chi2 : 2.0 * std::sqrt(bound * chi2) - bound;
  }

  const Intrinsics& camera_;
  std::span<const PoseObservation> observations_;
  const std::vector<uint8_t>& is_inlier_;
  bool robust_;
};

Rigid3 Minimize(const PoseProblem& problem, Rigid3 pose, const PoseOptimizationOptions& options) {
  Matrix6d hessian;
  Vector6d gradient;
  double damping = 1e-5;  // relative to the diagonal
  double cost = problem.Cost(pose);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    problem.Linearize(pose, hessian, gradient);
    Matrix6d damped = hessian;
    damped.diagonal() += damping * hessian.diagonal() + Vector6d::Constant(1e-12);
    const Vector6d step = damped.ldlt().solve(-gradient);
    if (!step.allFinite()) {
      break;
    }
    const Rigid3 moved = Retract(pose, step);
    const double moved_cost = problem.Cost(moved);
    if (!(moved_cost < cost)) {
      damping *= 10.0;
      continue;
    }
    const double decrease = (cost - moved_cost) / cost;
    pose = moved;
    cost = moved_cost;
    damping = std::max(damping * 0.1, 1e-9);
    if (decrease < options.min_relative_decrease) {
      break;
    }
  }
  return pose;
}

// Chooses as inliers the observations whose squared error at the result's pose is at most what
// `bound` says of them.
template <typename BoundFunction>
void ChooseInliers(const Intrinsics& camera, std::span<const PoseObservation> observations,
                   const BoundFunction& bound, PoseOptimizationResult& result) {
  result.inlier_count = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    const bool is_inlier =
        Chi2(camera, observations[i], result.cam_from_world) <= bound(observations[i]);
    result.is_inlier[i] = is_inlier ? 1 : 0;
    result.inlier_count += is_inlier ? 1 : 0;
  }
}

}  // namespace

PoseOptimizationResult OptimizePose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                    std::span<const PoseObservation> observations,
                                    const PoseOptimizationOptions& options) {
  const Intrinsics intrinsics = ToIntrinsics(camera);
  PoseOptimizationResult result;
  result.cam_from_world = cam_from_world;
  result.is_inlier.assign(observations.size(), 0);
  // At first all but those behind the camera: their error is infinite and would hide that of the
  // others.
  const auto any_finite = [](const PoseObservation&) { return std::numeric_limits<double>::max(); };
  ChooseInliers(intrinsics, observations, any_finite, result);
  for (int round = 0; round < options.rounds && result.inlier_count >= 3; ++round) {
    const PoseProblem problem(intrinsics, observations, result.is_inlier,
                              round < options.robust_rounds);
    result.cam_from_world = Minimize(problem, result.cam_from_world, options);
    ChooseInliers(intrinsics, observations, Bound, result);
  }
  if (result.inlier_count < 3) {
    result.cam_from_world = cam_from_world;
  }
  return result;
}

}  // namespace hullslam
