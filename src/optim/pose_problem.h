// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/tiny_solver.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/sim3.h"
#include "optim/pose_optimization.h"
#include "optim/square_root_form.h"

namespace hullslam::internal {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// The robust squared errors of the inliers among the observations.
class PointTerms {
 public:
  PointTerms(const PinholeCamera& camera, std::span<const PoseObservation> observations,
             const std::vector<uint8_t>& is_inlier, bool robust)
      : camera_(camera), observations_(observations), is_inlier_(is_inlier), robust_(robust) {}

  // Infinite if an inlier is behind the camera.
  double Cost(const Rigid3& pose) const;
  // Sets hessian and gradient with respect to the six parameters of Retract: those of half of the
  // cost.
  void Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const;

 private:
  const PinholeCamera& camera_;
  std::span<const PoseObservation> observations_;
  const std::vector<uint8_t>& is_inlier_;
  bool robust_;
};

// Decides which observations are inliers at the result's pose: those with an error of at most their
// OutlierBound, or all that are in front of the camera. Returns whether any of them changed.
enum class InlierRule { kBelowBound, kInFront };
bool ChooseInliers(const PinholeCamera& camera, std::span<const PoseObservation> observations,
                   InlierRule rule, PoseOptimizationResult& result);

// A problem in the form that ceres::TinySolver needs: six residuals, which are the SquareRootForm
// of the normal equations, and one more, which makes the squared norm of all seven equal to the
// cost. A Problem has functions Cost and Linearize like those of PointTerms.
//
// TinySolver adds steps to its parameters and does not support manifolds. So the parameters are
// only the sum of all steps. The pose is that of the last linearisation, moved with Retract by the
// steps since then. The derivatives by the parameters are then those of Linearize.
//
// A Pose may also be a Sim3, which has seven parameters and therefore eight residuals.
template <typename Problem, typename Pose = Rigid3>
class TinyPoseFunction {
 public:
  static constexpr int kSize = std::is_same_v<Pose, Sim3> ? 7 : 6;
  using Scalar = double;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  enum { NUM_RESIDUALS = kSize + 1, NUM_PARAMETERS = kSize };

  TinyPoseFunction(const Problem& problem, const Pose& start)
      : problem_(problem), pose_(start), cost_(problem.Cost(start)) {}

  double start_cost() const { return cost_; }
  Pose PoseAt(const Vector& parameters) const { return Retract(pose_, parameters - steps_); }

  // `jacobian`: NUM_RESIDUALS x NUM_PARAMETERS, by columns; may be null.
  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const Vector steps = Eigen::Map<const Vector>(parameters);
    const Pose pose = PoseAt(steps);
    // TinySolver asks for the derivatives at the same parameters for which it has just asked for
    // the cost, so the cost is still known.
    if (steps != cost_steps_) {
      cost_ = problem_.Cost(pose);
      cost_steps_ = steps;
    }
    Eigen::Map<Eigen::Matrix<double, kSize + 1, 1>> all(residuals);
    all.setZero();
    all[kSize] = std::sqrt(cost_);
    if (jacobian == nullptr) {
      return true;
    }
    pose_ = pose;
    steps_ = steps;
    Matrix hessian;
    Vector gradient;
    problem_.Linearize(pose, hessian, gradient);
    Eigen::Map<Eigen::Matrix<double, kSize + 1, kSize>> by_parameters(jacobian);
    by_parameters.setZero();
    // Without a factorisation the derivative is zero, so the solver takes no step.
    if (form_.Compute(hessian, gradient)) {
      all << form_.residual(), form_.LastResidual(cost_);
      by_parameters.template topRows<kSize>() = Matrix(form_.jacobian());
    }
    return true;
  }

 private:
  const Problem& problem_;
  mutable Pose pose_;  // pose of the last linearisation
  mutable Vector steps_ = Vector::Zero();
  mutable double cost_;
  mutable Vector cost_steps_ = Vector::Zero();  // the parameters that cost_ belongs to
  mutable SquareRootForm<kSize> form_;
};

// The pose (Rigid3 or Sim3) with the least cost, by Levenberg-Marquardt, starting at `pose`.
template <typename Problem, typename Pose>
Pose Minimize(const Problem& problem, const Pose& pose, const PoseOptimizationOptions& options) {
  using Function = TinyPoseFunction<Problem, Pose>;
  const Function function(problem, pose);
  ceres::TinySolver<Function> solver;
  solver.options.max_num_iterations = options.iterations + 1;  // TinySolver counts from one
  // The tolerance is in units of the squared norm of the residuals, which is the cost.
  solver.options.function_tolerance = options.min_relative_decrease * function.start_cost();
  typename Function::Vector steps = Function::Vector::Zero();
  solver.Solve(function, &steps);
  return function.PoseAt(steps);
}

}  // namespace hullslam::internal
