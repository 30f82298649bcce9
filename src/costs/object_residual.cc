// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/costs/object_residual.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hullslam {
namespace {

using Names = std::array<std::string_view, 5>;

// In the order of the enumerators.
constexpr Names kResidualNames = {"tangent", "algebraic_plane", "algebraic_point", "distribution",
                                  "overlap"};
constexpr Names kPrimitiveNames = {"support", "hull", "contour", "bbox", "conic"};

template <typename Enum>
std::optional<Enum> ByName(const Names& names, std::string_view name) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) {
    return std::nullopt;
  }
  return static_cast<Enum>(it - names.begin());
}

}  // namespace

std::string_view NameOf(ObjectResidual residual) {
  return kResidualNames.at(static_cast<size_t>(residual));
}

std::string_view NameOf(ObjectPrimitive primitive) {
  return kPrimitiveNames.at(static_cast<size_t>(primitive));
}

std::optional<ObjectResidual> ObjectResidualByName(std::string_view name) {
  return ByName<ObjectResidual>(kResidualNames, name);
}

std::optional<ObjectPrimitive> ObjectPrimitiveByName(std::string_view name) {
  return ByName<ObjectPrimitive>(kPrimitiveNames, name);
}

std::vector<std::string> ObjectResidualNames() {
  return {kResidualNames.begin(), kResidualNames.end()};
}

std::vector<std::string> ObjectPrimitiveNames() {
  return {kPrimitiveNames.begin(), kPrimitiveNames.end()};
}

bool IsSupported(ObjectResidual residual, ObjectPrimitive primitive) {
  switch (residual) {
    case ObjectResidual::kTangent:
    case ObjectResidual::kAlgebraicPlane:
      return true;
    case ObjectResidual::kAlgebraicPoint:
      return primitive == ObjectPrimitive::kContour;
    case ObjectResidual::kDistribution:
      return primitive == ObjectPrimitive::kConic;
    case ObjectResidual::kOverlap:
      return primitive != ObjectPrimitive::kSupport;
  }
  return false;
}

}  // namespace hullslam
