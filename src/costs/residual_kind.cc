// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/residual_kind.h"

#include <utility>

namespace hullslam {

std::unique_ptr<ceres::CostFunction> MakeObjectCost(
    ObjectResidual residual, const PinholeCamera& camera, const Detection& detection,
    std::span<const SilhouetteLine> lines, double sigma, std::optional<Ellipse> projected) {
  if (!AcceptsPrimitive(residual, detection.primitive)) {
    return nullptr;
  }
  return KindOf(residual).make_cost({.camera = camera,
                                     .detection = detection,
                                     .lines = lines,
                                     .sigma = sigma,
                                     .projected = std::move(projected)});
}

}  // namespace hullslam
