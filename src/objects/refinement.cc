// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/refinement.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "costs/manifolds.h"
#include "objects/constraint/object_constraint.h"

namespace hullslam {
namespace {

// The loss scale in sigmas is the same for every misfit.
ObjectConstraintOptions ConstraintOf(const ObjectRefinementOptions& options) {
  ObjectConstraintOptions constraint = options.constraint;
  constraint.loss_scale = options.loss_px / options.max_misfit_px;
  return constraint;
}

class RefinementProblem {
 public:
  RefinementProblem(const Ellipsoid& ellipsoid, const Ellipsoid& start, const Sensor& sensor,
                    std::span<const ResolvedObservation> observations, double misfit_px,
                    const ObjectConstraintOptions& options)
      : object_(ToBlock(ellipsoid.world_from_object)),
        log_axes_(ellipsoid.half_axes.array().log()) {
    poses_.reserve(observations.size());
    bool has_depth = false;
    for (const ResolvedObservation& observation : observations) {
      poses_.push_back(ToBlock(observation.cam_from_world));
      ObjectConstraint constraint =
          MakeObjectConstraint(sensor.camera, observation, observation.detection->lines, ellipsoid,
                               misfit_px, options, observation.detection->right_lines);
      Add(std::move(constraint.silhouette), poses_.back());
      Add(std::move(constraint.depth), poses_.back());
      has_depth = has_depth || !observation.detection->points.empty();
    }
    problem_.AddResidualBlock(MakeObjectPrior(start, has_depth, options).release(), nullptr,
                              object_.data(), log_axes_.data());
  }

  // Half the sum of squares at the minimum; nothing if the solver failed.
  std::optional<double> Solve(int iterations) {
    problem_.SetManifold(object_.data(), &manifold_);
    for (PoseBlock& pose : poses_) {
      if (problem_.HasParameterBlock(pose.data())) {
        problem_.SetParameterBlockConstant(pose.data());
      }
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = iterations;
    solver.function_tolerance = 1e-5;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    const bool is_finite = log_axes_.allFinite() && std::isfinite(summary.final_cost);
    return summary.IsSolutionUsable() && is_finite ? std::optional(summary.final_cost)
                                                   : std::nullopt;
  }

  Ellipsoid Result() const { return {FromBlock(object_.data()), log_axes_.array().exp()}; }

 private:
  static ceres::Problem::Options ProblemOptions() {
    ceres::Problem::Options options;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  void Add(std::unique_ptr<RobustRowsCost> cost, PoseBlock& pose) {
    if (cost != nullptr) {
      problem_.AddResidualBlock(cost.release(), nullptr, pose.data(), object_.data(),
                                log_axes_.data());
    }
  }

  PoseBlock object_;
  Eigen::Vector3d log_axes_;
  std::vector<PoseBlock> poses_;
  PoseManifold manifold_;
  ceres::Problem problem_{ProblemOptions()};
};

}  // namespace

Refinement RefineEllipsoid(const Ellipsoid& ellipsoid, const Ellipsoid& start, const Sensor& sensor,
                           std::span<const ResolvedObservation> observations, double misfit_px,
                           const ObjectRefinementOptions& options) {
  const double bounded_px = std::clamp(
      misfit_px, std::min(options.min_misfit_px, options.max_misfit_px), options.max_misfit_px);
  RefinementProblem problem(ellipsoid, start, sensor, observations, bounded_px,
                            ConstraintOf(options));
  const std::optional<double> cost = problem.Solve(options.iterations);
  if (!cost) {
    return {ellipsoid, 0.0, false};
  }
  return {problem.Result(), *cost, true};
}

}  // namespace hullslam
