// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "hullslam/camera/pinhole.h"
#include "hullslam/costs/object_residual.h"
#include "hullslam/frame/detection.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The data from which the cost of one detection is made.
struct ObjectCostInput {
  const PinholeCamera& camera;
  const Detection& detection;
  std::span<const SilhouetteLine> lines;  // of the detection, possibly moved by misfit compensation
  double sigma;                           // in the unit of the residual
  // The projected ellipse at the start of the optimisation. Only for kinds that need it.
  std::optional<Ellipse> projected = std::nullopt;
};

// How large an ellipsoid appears in an image.
struct ProjectedSize {
  double radius_px;  // radius of the circle with the area of the projected ellipse
  double depth;      // of the ellipsoid's centre, m
  double focal_px;   // a pixel is depth / focal_px wide at that depth
};

// The properties in which the kinds of residuals differ. Each kind has one constant of this type
// beside its cost, and the table in object_residual.cc lists all constants.
struct ResidualKind {
  std::string_view name;                        // in settings files
  std::span<const ObjectPrimitive> primitives;  // from which the residual can be computed
  bool takes_lines = false;                     // whether it is computed from the detection's lines
  // The size of the residual if the whole measured outline is `error_px` outside of the true one
  // (ResidualOfPixelError).
  double (*of_pixel_error)(double error_px, const ProjectedSize& size);
  // Null if the detection lacks the data that the residual needs. The primitive is one of
  // `primitives`.
  std::unique_ptr<ceres::CostFunction> (*make_cost)(const ObjectCostInput& input);
  bool needs_projection = false;  // whether it is made from ObjectCostInput::projected
};

// ResidualKind::make_cost of a cost of the detection's lines.
template <typename Cost>
std::unique_ptr<ceres::CostFunction> MakeLineCost(const ObjectCostInput& input) {
  return input.lines.empty() ? nullptr
                             : std::make_unique<Cost>(input.camera, input.lines, input.sigma);
}

inline constexpr std::array kAllPrimitives = {
    ObjectPrimitive::kSupport, ObjectPrimitive::kHull,  ObjectPrimitive::kContour,
    ObjectPrimitive::kBox,     ObjectPrimitive::kConic, ObjectPrimitive::kBoxEllipse};

const ResidualKind& KindOf(ObjectResidual residual);

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

// The approximate size of a residual, in its own unit, when the whole measured silhouette is
// `error_px` outside of the true one. As the sigma of a residual whose silhouette has a sigma of
// `error_px`, it gives all kinds of residuals the same weight. Let r be the radius of the circle
// that has the area of the projected ellipse, z the depth of the ellipsoid's centre and f the focal
// length:
//   tangent          error_px
//   algebraic_plane  2 h e with h = r z / f and e = error_px z / f
//   relative_plane   2 r error_px / f^2, which is algebraic_plane divided by z^2
//   algebraic_point  2 error_px / r
//   distribution     error_px^2 (Wasserstein, for an ellipse that is shifted by error_px)
//   overlap          1 - (r / (r + error_px))^2
//   bhattacharyya    error_px^2 / (8 r^2) (for an ellipse that is shifted by error_px)
//   box_bounds       error_px
//   filtered_point   2 error_px / r
// Nothing if the ellipsoid is not in front of the camera or its projected ellipse has no area.
std::optional<double> ResidualOfPixelError(ObjectResidual residual, const PinholeCamera& camera,
                                           const Rigid3& cam_from_world, const Ellipsoid& ellipsoid,
                                           double error_px);

}  // namespace hullslam
