// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hullslam/frame/object_primitive.h"

namespace hullslam {

// The residuals that can constrain a quadric (docs/objects.md). Each has its own file in costs/,
// and a row in the table of costs/object_residual.cc.
enum class ObjectResidual {
  kTangent,
  kAlgebraicPlane,
  kRelativePlane,
  kAlgebraicPoint,
  kDistribution,
  kOverlap,
  kBhattacharyya,
  kBoxBounds,
  kFilteredPoint
};

// The name in settings files: tangent, algebraic_plane, ...
std::string_view NameOf(ObjectResidual residual);
// All names, in the order of the enumerators.
std::vector<std::string> ObjectResidualNames();

// Whether the residual can be computed from the primitive. Each residual names its primitives
// beside its cost. Every primitive has lines (a conic has its tangents). A contour, a conic or a
// region belongs to some primitives only, so a residual that needs one of these does not accept all
// primitives.
bool AcceptsPrimitive(ObjectResidual residual, ObjectPrimitive primitive);

// Whether the residual is computed from the lines of a detection.
bool TakesLines(ObjectResidual residual);

// Whether its cost depends on the projected ellipse at the start of the optimisation.
bool NeedsProjection(ObjectResidual residual);

// Standard deviations of the prior on an ellipsoid.
struct QuadricPriorSigmas {
  double log_axes = 0.5;  // natural logarithm of each half axis
  double center = 0.5;    // relative to the geometric mean of the half axes of the prior's shape
  double rotation = 0.5;  // radians
};

}  // namespace hullslam
