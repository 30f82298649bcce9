// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/make_object_cost.h"

#include "costs/residual_kind.h"

namespace hullslam {

std::unique_ptr<ceres::CostFunction> MakeObjectCost(ObjectResidual residual,
                                                    const PinholeCamera& camera,
                                                    const Detection& detection,
                                                    std::span<const SilhouetteLine> lines,
                                                    double sigma) {
  if (!AcceptsPrimitive(residual, detection.primitive)) {
    return nullptr;
  }
  return KindOf(residual).make_cost(
      {.camera = camera, .detection = detection, .lines = lines, .sigma = sigma});
}

}  // namespace hullslam
