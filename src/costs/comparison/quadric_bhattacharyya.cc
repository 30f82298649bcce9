// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_distribution.h"
#include "costs/residual_kind.h"

namespace hullslam {
namespace {

constexpr std::array kEllipsePrimitives = {ObjectPrimitive::kConic, ObjectPrimitive::kBoxEllipse};

std::unique_ptr<ceres::CostFunction> MakeBhattacharyyaCost(const ObjectCostInput& input) {
  if (!input.detection.ellipse) {
    return nullptr;
  }
  return std::make_unique<DistributionCost>(input.camera, *input.detection.ellipse, input.sigma,
                                            DistributionDistance::kBhattacharyya);
}

// Of two circles of this radius whose centres are `error_px` apart.
double OfShift(double error_px, const ProjectedSize& size) {
  return error_px * error_px / (8.0 * size.radius_px * size.radius_px);
}

}  // namespace

const ResidualKind kBhattacharyyaResidual = {.name = "bhattacharyya",
                                             .primitives = kEllipsePrimitives,
                                             .takes_lines = false,
                                             .of_pixel_error = OfShift,
                                             .make_cost = MakeBhattacharyyaCost};

}  // namespace hullslam
