// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/costs/object_residual.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "costs/comparison/quadric_algebraic_plane.h"
#include "costs/comparison/quadric_algebraic_point.h"
#include "costs/comparison/quadric_box_bounds.h"
#include "costs/comparison/quadric_distribution.h"
#include "costs/comparison/quadric_overlap.h"
#include "costs/comparison/quadric_relative_plane.h"
#include "costs/quadric_tangent.h"
#include "costs/residual_kind.h"

namespace hullslam {
namespace {

// In the order of the enumerators.
constexpr std::array kKinds = {
    &kTangentResidual,        &kAlgebraicPlaneResidual, &kRelativePlaneResidual,
    &kAlgebraicPointResidual, &kDistributionResidual,   &kOverlapResidual,
    &kBhattacharyyaResidual,  &kBoxBoundsResidual,      &kFilteredPointResidual};

}  // namespace

const ResidualKind& KindOf(ObjectResidual residual) {
  return *kKinds.at(static_cast<size_t>(residual));
}

std::string_view NameOf(ObjectResidual residual) { return KindOf(residual).name; }

std::vector<std::string> ObjectResidualNames() {
  std::vector<std::string> names;
  for (const ResidualKind* const kind : kKinds) {
    names.emplace_back(kind->name);
  }
  return names;
}

bool AcceptsPrimitive(ObjectResidual residual, ObjectPrimitive primitive) {
  const auto primitives = KindOf(residual).primitives;
  return std::find(primitives.begin(), primitives.end(), primitive) != primitives.end();
}

bool TakesLines(ObjectResidual residual) { return KindOf(residual).takes_lines; }

bool NeedsProjection(ObjectResidual residual) { return KindOf(residual).needs_projection; }

}  // namespace hullslam
