// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/object_primitive.h"

#include <array>
#include <cstddef>

namespace hullslam {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 6> kNames = {"support", "hull",  "contour",
                                                    "bbox",    "conic", "box_ellipse"};

}  // namespace

std::string_view NameOf(ObjectPrimitive value) { return kNames.at(static_cast<size_t>(value)); }

std::vector<std::string> ObjectPrimitiveNames() { return {kNames.begin(), kNames.end()}; }

}  // namespace hullslam
