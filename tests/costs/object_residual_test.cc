// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/costs/object_residual.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

TEST(ObjectResidual, NamesAreInTheOrderOfTheEnumerators) {
  const std::vector<std::string> names = ObjectResidualNames();
  for (const ObjectResidual residual : AllResiduals()) {
    EXPECT_EQ(NameOf(residual), names[static_cast<size_t>(residual)]);
  }
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(ObjectResidual, ThereIsNoneAfterTheLast) {
  EXPECT_THROW(KindOf(static_cast<ObjectResidual>(AllResiduals().size())), std::out_of_range);
}

TEST(ObjectResidual, OfLinesTakesEveryPrimitive) {
  for (const ObjectResidual residual : AllResiduals()) {
    size_t accepted = 0;
    for (const ObjectPrimitive primitive : kAllPrimitives) {
      accepted += AcceptsPrimitive(residual, primitive) ? 1 : 0;
    }
    EXPECT_GT(accepted, 0u) << NameOf(residual);
    if (TakesLines(residual)) {
      EXPECT_EQ(accepted, ObjectPrimitiveNames().size()) << NameOf(residual);
    }
  }
}

TEST(QuadricPriorSigmas, ArePositiveByDefault) {
  constexpr QuadricPriorSigmas kSigmas;
  EXPECT_GT(kSigmas.log_axes, 0.0);
  EXPECT_GT(kSigmas.center, 0.0);
  EXPECT_GT(kSigmas.rotation, 0.0);
}

}  // namespace
}  // namespace hullslam
