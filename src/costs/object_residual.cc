// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/costs/object_residual.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hullslam {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 5> kNames = {"tangent", "algebraic_plane", "algebraic_point",
                                                    "distribution", "overlap"};

}  // namespace

std::string_view NameOf(ObjectResidual value) { return kNames.at(static_cast<size_t>(value)); }

std::optional<ObjectResidual> ObjectResidualByName(std::string_view name) {
  const auto it = std::find(kNames.begin(), kNames.end(), name);
  if (it == kNames.end()) {
    return std::nullopt;
  }
  return static_cast<ObjectResidual>(it - kNames.begin());
}

std::vector<std::string> ObjectResidualNames() { return {kNames.begin(), kNames.end()}; }

bool AcceptsPrimitive(ObjectResidual residual, ObjectPrimitive primitive) {
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
