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

TEST(ObjectResidual, NamesAreInTheOrderOfTheEnumerators) {
  const std::vector<std::string> names = ObjectResidualNames();
  ASSERT_EQ(names.size(), 5u);
  for (size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(NameOf(static_cast<ObjectResidual>(i)), names[i]);
  }
}

TEST(ObjectResidual, OnlyTwoTakeLines) {
  EXPECT_TRUE(TakesLines(ObjectResidual::kTangent));
  EXPECT_TRUE(TakesLines(ObjectResidual::kAlgebraicPlane));
  EXPECT_FALSE(TakesLines(ObjectResidual::kAlgebraicPoint));
  EXPECT_FALSE(TakesLines(ObjectResidual::kDistribution));
  EXPECT_FALSE(TakesLines(ObjectResidual::kOverlap));
}

TEST(AcceptsPrimitive, AcceptsTheCombinationsThatMakeSense) {
  std::set<std::string> supported;
  const std::vector<std::string> residuals = ObjectResidualNames();
  const std::vector<std::string> primitives = ObjectPrimitiveNames();
  for (size_t i = 0; i < residuals.size(); ++i) {
    for (size_t k = 0; k < primitives.size(); ++k) {
      if (AcceptsPrimitive(static_cast<ObjectResidual>(i), static_cast<ObjectPrimitive>(k))) {
        supported.insert(residuals[i] + " " + primitives[k]);
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
