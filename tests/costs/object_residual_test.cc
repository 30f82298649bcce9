// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/costs/object_residual.h"

#include <gtest/gtest.h>

#include <set>

namespace hullslam {
namespace {

TEST(ObjectResidual, NamesAreThoseOfTheSettings) {
  EXPECT_EQ(NameOf(ObjectResidual::kTangent), "tangent");
  EXPECT_EQ(NameOf(ObjectResidual::kAlgebraicPlane), "algebraic_plane");
  EXPECT_EQ(NameOf(ObjectResidual::kAlgebraicPoint), "algebraic_point");
  EXPECT_EQ(NameOf(ObjectResidual::kDistribution), "distribution");
  EXPECT_EQ(NameOf(ObjectResidual::kOverlap), "overlap");
}

TEST(ObjectResidual, EveryNameLeadsBack) {
  ASSERT_EQ(ObjectResidualNames().size(), 5u);
  for (const std::string& name : ObjectResidualNames()) {
    ASSERT_TRUE(ObjectResidualByName(name).has_value()) << name;
    EXPECT_EQ(NameOf(*ObjectResidualByName(name)), name);
  }
}

TEST(ObjectResidual, OtherNamesAreNone) {
  for (const char* name : {"", "Tangent", "tangent ", "support"}) {
    EXPECT_FALSE(ObjectResidualByName(name).has_value()) << name;
  }
}

TEST(AcceptsPrimitive, HoldsTheCombinationsThatMakeSense) {
  std::set<std::string> supported;
  for (const std::string& residual : ObjectResidualNames()) {
    for (const std::string& primitive : ObjectPrimitiveNames()) {
      if (AcceptsPrimitive(*ObjectResidualByName(residual), *ObjectPrimitiveByName(primitive))) {
        supported.insert(residual + " " + primitive);
      }
    }
  }
  const std::set<std::string> expected = {"tangent support",
                                          "tangent hull",
                                          "tangent contour",
                                          "tangent bbox",
                                          "tangent conic",
                                          "algebraic_plane support",
                                          "algebraic_plane hull",
                                          "algebraic_plane contour",
                                          "algebraic_plane bbox",
                                          "algebraic_plane conic",
                                          "algebraic_point contour",
                                          "distribution conic",
                                          "overlap hull",
                                          "overlap contour",
                                          "overlap bbox",
                                          "overlap conic"};
  EXPECT_EQ(supported, expected);
}

}  // namespace
}  // namespace hullslam
