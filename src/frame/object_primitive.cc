// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/object_primitive.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hullslam {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 5> kNames = {"support", "hull", "contour", "bbox", "conic"};

}  // namespace

std::string_view NameOf(ObjectPrimitive value) { return kNames.at(static_cast<size_t>(value)); }

std::optional<ObjectPrimitive> ObjectPrimitiveByName(std::string_view name) {
  const auto it = std::find(kNames.begin(), kNames.end(), name);
  if (it == kNames.end()) {
    return std::nullopt;
  }
  return static_cast<ObjectPrimitive>(it - kNames.begin());
}

std::vector<std::string> ObjectPrimitiveNames() { return {kNames.begin(), kNames.end()}; }

}  // namespace hullslam
