// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/refinement.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "costs/depth_anchor.h"
#include "costs/make_object_cost.h"
#include "costs/object_measurement.h"
#include "costs/pixel_error.h"
#include "costs/pose_manifold.h"
#include "costs/quadric_prior.h"
#include "costs/robust_rows.h"

namespace hullslam {
namespace {

constexpr int kIterations = 20;
constexpr size_t kAnchorsAView = 20;   // depth points that stand for the others
constexpr double kAnchorWeight = 1.0;  // of one view's depth points together
// The start's centre and turn are those of the side that was seen: they hold next to nothing.
constexpr double kPriorCenter = 2.0;    // sizes of the start
constexpr double kPriorRotation = 1.0;  // rad

// Every k-th point, so that at most `count` are left.
std::vector<Eigen::Vector3d> Thin(std::span<const Eigen::Vector3d> points, size_t count) {
  const size_t step = (points.size() + count - 1) / count;
  std::vector<Eigen::Vector3d> thinned;
  for (size_t i = 0; i < points.size(); i += std::max<size_t>(1, step)) {
    thinned.push_back(points[i]);
  }
  return thinned;
}

class RefinementProblem {
 public:
  RefinementProblem(const Ellipsoid& ellipsoid, const Sensor& sensor,
                    std::span<const ObjectView> views, double sigma_px,
                    const ObjectOptions& options)
      : options_(options),
        sigma_px_(sigma_px),
        camera_(sensor.camera),
        object_(ToBlock(ellipsoid.world_from_object)),
        log_axes_(ellipsoid.half_axes.array().log()) {
    poses_.reserve(views.size());
    for (const ObjectView& view : views) {
      PoseBlock& pose = poses_.emplace_back(ToBlock(view.cam_from_world));
      AddOutline(*view.detection, view.cam_from_world, ellipsoid, pose);
      AddAnchor(*view.detection, pose);
      has_depth_ = has_depth_ || !view.detection->points.empty();
    }
  }

  void AddPrior(const Ellipsoid& start) {
    const double sigma = has_depth_ ? options_.prior_sigma : options_.prior_sigma_blind;
    problem_.AddResidualBlock(
        new QuadricPriorCost(
            start, {.log_axes = sigma, .center = kPriorCenter, .rotation = kPriorRotation}),
        nullptr, object_.data(), log_axes_.data());
  }

  // Half the sum of squares at the minimum; nothing where the solver failed.
  std::optional<double> Solve() {
    problem_.SetManifold(object_.data(), &manifold_);
    for (PoseBlock& pose : poses_) {
      if (problem_.HasParameterBlock(pose.data())) {
        problem_.SetParameterBlockConstant(pose.data());
      }
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = kIterations;
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

  void AddOutline(const Detection& detection, const Rigid3& cam_from_world,
                  const Ellipsoid& ellipsoid, PoseBlock& pose) {
    const auto sigma =
        ResidualOfPixelError(options_.residual, camera_, cam_from_world, ellipsoid, sigma_px_);
    if (!sigma) {
      return;
    }
    std::unique_ptr<ceres::CostFunction> cost = MakeObjectCost(
        options_.residual, options_.detection.primitive, camera_, ToMeasurement(detection), *sigma);
    if (cost == nullptr) {
      return;
    }
    const double weight = std::min(1.0, options_.refinement_lines / cost->num_residuals());
    auto loss =
        std::make_unique<ceres::HuberLoss>(options_.refinement_huber / options_.refinement_sigma);
    problem_.AddResidualBlock(new RobustRowsCost(std::move(cost), std::move(loss), weight), nullptr,
                              pose.data(), object_.data(), log_axes_.data());
  }

  void AddAnchor(const Detection& detection, PoseBlock& pose) {
    const std::vector<Eigen::Vector3d> points = Thin(detection.points, kAnchorsAView);
    if (points.empty()) {
      return;
    }
    problem_.AddResidualBlock(
        new RobustRowsCost(std::make_unique<DepthAnchorCost>(points, options_.depth_sigma),
                           std::make_unique<ceres::CauchyLoss>(1.0),
                           kAnchorWeight / static_cast<double>(points.size())),
        nullptr, pose.data(), object_.data(), log_axes_.data());
  }

  const ObjectOptions& options_;
  double sigma_px_;
  PinholeCamera camera_;
  PoseBlock object_;
  Eigen::Vector3d log_axes_;
  std::vector<PoseBlock> poses_;
  bool has_depth_ = false;
  PoseManifold manifold_;
  ceres::Problem problem_{ProblemOptions()};
};

}  // namespace

Refinement RefineEllipsoid(const Ellipsoid& ellipsoid, const Ellipsoid& start, const Sensor& sensor,
                           std::span<const ObjectView> views, double sigma_px,
                           const ObjectOptions& options) {
  RefinementProblem problem(ellipsoid, sensor, views, sigma_px, options);
  problem.AddPrior(start);
  const std::optional<double> cost = problem.Solve();
  if (!cost) {
    return {ellipsoid, 0.0, false};
  }
  return {problem.Result(), *cost, true};
}

}  // namespace hullslam
