// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// The part of an instance mask from which the residuals of its object are computed.
enum class ObjectPrimitive { kSupport, kHull, kContour, kBox, kConic };

// The name in settings: support, hull, contour, bbox, conic.
std::string_view NameOf(ObjectPrimitive primitive);
// Nothing for an unknown name.
std::optional<ObjectPrimitive> ObjectPrimitiveByName(std::string_view name);
// All names, in the order of the enumerators.
std::vector<std::string> ObjectPrimitiveNames();

}  // namespace hullslam
