// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/quadric_tangent.h"

#include <gtest/gtest.h>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

std::vector<SilhouetteLine> Shifted(std::vector<SilhouetteLine> lines, double outwards) {
  for (SilhouetteLine& line : lines) {
    line.line.offset -= outwards;
  }
  return lines;
}

std::vector<SilhouetteLine> OneSided(std::vector<SilhouetteLine> lines) {
  for (SilhouetteLine& line : lines) {
    line.is_one_sided = true;
  }
  return lines;
}

TEST(TangentCost, ByHand) {
  // The ellipse reaches from x = 320 - 375 to 320 + 375, and up to y = 240 - 300.
  const std::vector<SilhouetteLine> lines = {{{{1.0, 0.0}, -690.0}, false},   // x <= 690
                                             {{{-1.0, 0.0}, -61.0}, false},   // x >= -61
                                             {{{0.0, -1.0}, -60.0}, false}};  // y >= -60
  const TangentCost cost(kObjectCamera, lines, 2.0);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, SphereAhead());
  EXPECT_NEAR(residuals[0], 2.5, 1e-9);   // reaches 5 px beyond the line
  EXPECT_NEAR(residuals[1], -3.0, 1e-9);  // ends 6 px before the line
  EXPECT_NEAR(residuals[2], 0.0, 1e-9);
}

TEST(TangentCost, IsZeroForEveryTangent) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const TangentCost cost(kObjectCamera, TangentsOf(state, 16), 1.0);
    EXPECT_LT(ObjectResidualsOf(cost, state).norm(), 1e-7);
  }
}

TEST(TangentCost, IsTheSignedDistanceInPixels) {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const double outwards = random.Number(-8.0, 8.0);
    const TangentCost cost(kObjectCamera, Shifted(TangentsOf(state, 16), outwards), 1.0);
    EXPECT_LT((ObjectResidualsOf(cost, state).array() + outwards).matrix().norm(), 1e-7);
  }
}

TEST(TangentCost, KeepsTheLaws) {
  RandomGeometry random(3);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const TangentCost cost(kObjectCamera, TangentsOf(RandomSeenEllipsoid(random), 12), 1.7);
    ExpectObjectCostLaws(cost, state, random);
  }
}

// A one-sided line only tells that the object reaches at least to the line.
TEST(TangentCost, OneSidedIsZeroWhereTheOutlineReachesTheLine) {
  RandomGeometry random(4);
  for (int i = 0; i < 10; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const std::vector<SilhouetteLine> lines = OneSided(TangentsOf(state, 16));
    const TangentCost over(kObjectCamera, Shifted(lines, -3.0), 1.0);
    EXPECT_EQ(ObjectResidualsOf(over, state).norm(), 0.0);
    ExpectTrueObjectGradient(over, state);
    const TangentCost shy(kObjectCamera, Shifted(lines, 3.0), 1.0);
    EXPECT_LT((ObjectResidualsOf(shy, state).array() + 3.0).matrix().norm(), 1e-7);
    ExpectTrueObjectGradient(shy, state);
  }
}

TEST(TangentCost, IsNotDefinedUnlessInFront) {
  ExpectUndefinedUnlessInFront(TangentCost(kObjectCamera, TangentsOf(SphereAhead(), 8), 1.0));
}

TEST(TangentDistance, IsTheResidual) {
  RandomGeometry random(5);
  const SeenEllipsoid state = RandomSeenEllipsoid(random);
  const std::vector<SilhouetteLine> lines = TangentsOf(RandomSeenEllipsoid(random), 5);
  const TangentCost cost(kObjectCamera, lines, 1.0);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, state);
  const ObjectBlocks blocks(state);
  const QuadricInCamera quadric(blocks.Pointers().data());
  const EllipseProjection ellipse(kObjectCamera, quadric);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(TangentDistance(lines[static_cast<size_t>(i)], ellipse.numbers()), residuals[i]);
  }
}

TEST(TangentCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kTangent, "tangent", true,
             {kAllPrimitives.begin(), kAllPrimitives.end()});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kTangent), 1.5, 1e-12);
}

}  // namespace
}  // namespace hullslam
