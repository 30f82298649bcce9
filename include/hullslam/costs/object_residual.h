// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/frame/object_primitive.h"

namespace hullslam {

// The residuals that can hold a quadric (docs/objects.md); each has its own file in costs/.
enum class ObjectResidual { kTangent, kAlgebraicPlane, kAlgebraicPoint, kDistribution, kOverlap };

// The name in settings: tangent, algebraic_plane, ...
std::string_view NameOf(ObjectResidual residual);
// Nothing for an unknown name.
std::optional<ObjectResidual> ObjectResidualByName(std::string_view name);
// All names, in the order of the enumerators.
std::vector<std::string> ObjectResidualNames();

// Whether the residual can be computed from the primitive: tangent and algebraic_plane take lines,
// which every primitive has (of a conic: tangents), algebraic_point takes the contour,
// distribution the conic, and overlap any region; support lines bound no region of their own.
bool IsSupported(ObjectResidual residual, ObjectPrimitive primitive);

}  // namespace hullslam
