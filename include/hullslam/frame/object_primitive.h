// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// The geometric shape, taken from an instance mask, from which an object's residuals are computed.
enum class ObjectPrimitive { kSupport, kHull, kContour, kBox, kConic, kBoxEllipse };

// The name in settings files: support, hull, contour, bbox, conic or box_ellipse.
std::string_view NameOf(ObjectPrimitive primitive);
// All names, in the order of the enumerators.
std::vector<std::string> ObjectPrimitiveNames();

}  // namespace hullslam
