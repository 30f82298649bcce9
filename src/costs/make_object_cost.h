// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>

#include "hullslam/camera/pinhole.h"
#include "hullslam/costs/object_residual.h"
#include "hullslam/geometry/conic.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// What a detection offers to the residuals; undistorted pixels. The spans are not kept.
struct ObjectMeasurement {
  std::span<const SilhouetteLine> lines;
  std::span<const Eigen::Vector2d> contour;
  std::span<const Eigen::Vector2d> hull;
  std::optional<Ellipse> ellipse;
  Eigen::AlignedBox2d box;
};

// The residual of a detection over the parameters of QuadricInCamera, one row a line or contour
// point (at most 64, evenly chosen) or a single one. `sigma` is in the unit of the residual: see
// ResidualOfPixelError. Null where the residual and the primitive do not go together (IsSupported)
// or the measurement has nothing to compute it from: no line, fewer than three points, no ellipse.
std::unique_ptr<ceres::CostFunction> MakeObjectCost(ObjectResidual residual,
                                                    ObjectPrimitive primitive,
                                                    const PinholeCamera& camera,
                                                    const ObjectMeasurement& measurement,
                                                    double sigma);

}  // namespace hullslam
