// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/object_constraint.h"

#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "costs/depth_anchor.h"
#include "costs/quadric_prior.h"
#include "costs/residual_kind.h"
#include "costs/wrapped_costs.h"
#include "objects/constraint/misfit.h"
#include "objects/constraint/point_statistics.h"
#include "util/lists.h"

namespace hullslam {
namespace {

std::unique_ptr<ceres::LossFunction> MakeLoss(RobustLoss loss, double scale) {
  switch (loss) {
    case RobustLoss::kNone:
      return nullptr;
    case RobustLoss::kHuber:
      return std::make_unique<ceres::HuberLoss>(scale);
    case RobustLoss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(scale);
    case RobustLoss::kTukey:
      return std::make_unique<ceres::TukeyLoss>(scale);
  }
  return nullptr;
}

// The rows count as at most `max_effective_rows` independent rows.
std::unique_ptr<RobustRowsCost> MakeRobust(std::unique_ptr<ceres::CostFunction> cost,
                                           std::unique_ptr<ceres::LossFunction> loss,
                                           double max_effective_rows) {
  const double weight = std::min(1.0, max_effective_rows / cost->num_residuals());
  return std::make_unique<RobustRowsCost>(std::move(cost), std::move(loss), weight);
}

std::unique_ptr<RobustRowsCost> MakeSilhouette(const PinholeCamera& camera,
                                               const ResolvedObservation& observation,
                                               std::span<const SilhouetteLine> lines,
                                               const Ellipsoid& ellipsoid, double misfit_px,
                                               const ObjectConstraintOptions& options,
                                               std::span<const SilhouetteLine> right_lines) {
  const double sigma_px = std::hypot(options.sigma_px, options.misfit_factor * misfit_px);
  auto sigma = ResidualOfPixelError(options.residual, camera, observation.cam_from_world, ellipsoid,
                                    sigma_px);
  if (!sigma) {
    return nullptr;
  }
  if (options.sigma_unit == SigmaUnit::kResidual) {
    sigma = options.sigma_px;
  }
  std::optional<Ellipse> projected;
  if (NeedsProjection(options.residual)) {
    projected = ProjectEllipsoid(camera.Matrix(), observation.cam_from_world, ellipsoid);
  }
  std::vector<SilhouetteLine> scaled;
  if (camera.IsDistorted() && options.residual == ObjectResidual::kTangent) {
    scaled = ScaleToRaw(camera, *observation.detection, lines);
    lines = scaled;
  }
  auto cost =
      MakeObjectCost(options.residual, camera, *observation.detection, lines, *sigma, projected);
  if (cost == nullptr) {
    return nullptr;
  }
  if (!right_lines.empty() && TakesLines(options.residual)) {
    cost = std::make_unique<BothViewsCost>(
        std::move(cost),
        MakeObjectCost(options.residual, camera, *observation.detection, right_lines, *sigma),
        camera.bf / camera.fx);
  }
  const double scale = std::max(options.loss_scale, options.min_loss_px / sigma_px);
  return MakeRobust(std::move(cost), MakeLoss(options.loss, scale), options.max_effective_lines);
}

std::unique_ptr<RobustRowsCost> MakeDepth(const ResolvedObservation& observation,
                                          const ObjectDepthOptions& options) {
  const auto count = static_cast<size_t>(options.max_points);
  const std::vector<Eigen::Vector3d> points = options.choice == PointChoice::kEven
                                                  ? Thin(SurfacePoints(observation), count)
                                                  : EveryKth(SurfacePoints(observation), count);
  if (points.empty()) {
    return nullptr;
  }
  const bool is_measured = !observation.detection->points.empty();
  const double sigma = is_measured ? options.sigma : options.landmark_sigma * MeanOf(points).norm();
  return MakeRobust(std::make_unique<DepthAnchorCost>(points, sigma),
                    MakeLoss(options.loss, options.loss_scale), options.max_effective_points);
}

}  // namespace

ObjectConstraint MakeObjectConstraint(const PinholeCamera& camera,
                                      const ResolvedObservation& observation,
                                      std::span<const SilhouetteLine> lines,
                                      const Ellipsoid& ellipsoid, double misfit_px,
                                      const ObjectConstraintOptions& options,
                                      std::span<const SilhouetteLine> right_lines) {
  return {.silhouette = MakeSilhouette(camera, observation, lines, ellipsoid, misfit_px, options,
                                       right_lines),
          .depth = MakeDepth(observation, options.depth)};
}

std::unique_ptr<ceres::CostFunction> MakeObjectPrior(const Ellipsoid& shape, bool has_depth,
                                                     const ObjectConstraintOptions& options) {
  return std::make_unique<QuadricPriorCost>(
      shape, has_depth ? options.prior : options.prior_without_depth);
}

}  // namespace hullslam
