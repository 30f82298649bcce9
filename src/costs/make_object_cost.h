// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <optional>
#include <span>

#include "hullslam/camera/pinhole.h"
#include "hullslam/costs/object_residual.h"
#include "hullslam/frame/detection.h"

namespace hullslam {

// The residual of a detection over the parameters of QuadricInCamera: one row per line or contour
// point (at most 64, evenly chosen), or a single row. `lines` are the detection's lines, possibly
// after misfit compensation; residuals that use no lines take the detection's contour, hull,
// ellipse or box. `sigma` is in the unit of the residual: see ResidualOfPixelError. Null where the
// residual cannot be computed from the detection's primitive (AcceptsPrimitive) or where the
// detection lacks the data of the residual: a line, three points of a contour, or an ellipse.
// `projected` is the projected ellipse at the start, for residuals that need it (NeedsProjection).
std::unique_ptr<ceres::CostFunction> MakeObjectCost(
    ObjectResidual residual, const PinholeCamera& camera, const Detection& detection,
    std::span<const SilhouetteLine> lines, double sigma,
    std::optional<Ellipse> projected = std::nullopt);

}  // namespace hullslam
