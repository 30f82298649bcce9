// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_algebraic_point.h"

#include <gtest/gtest.h>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

TEST(AlgebraicPointCost, ByHand) {
  // The centre, a point on the ellipse, one at twice its half axis, and one at half of the other
  // axis.
  const std::vector<Eigen::Vector2d> points = {
      {320.0, 240.0}, {695.0, 240.0}, {320.0 - 750.0, 240.0}, {320.0, 90.0}};
  const AlgebraicPointCost cost(kObjectCamera, points, 0.5);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, SphereAhead());
  EXPECT_LT((residuals - Eigen::Vector4d(-2.0, 0.0, 6.0, -1.5)).norm(), 1e-9);
}

TEST(AlgebraicPointCost, IsZeroOnTheOutline) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const AlgebraicPointCost cost(kObjectCamera, ContourOf(state, 16), 1.0);
    EXPECT_LT(ObjectResidualsOf(cost, state).norm(), 1e-8);
  }
}

TEST(AlgebraicPointCost, KeepsTheLaws) {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const AlgebraicPointCost cost(kObjectCamera, ContourOf(RandomSeenEllipsoid(random), 8), 0.4);
    ExpectObjectCostLaws(cost, state, random);
  }
}

TEST(AlgebraicPointCost, IsNotDefinedUnlessInFront) {
  ExpectUndefinedUnlessInFront(AlgebraicPointCost(kObjectCamera, ContourOf(SphereAhead(), 8), 1.0));
}

// A point that is e px outside of a circle of radius r has an error of about 2 e / r. The standard
// deviation of this error is 2 (1 + e / r) sigma / r.
TEST(GateContour, LeavesThePointsNearTheOutline) {
  Ellipse circle;
  circle.center = {100.0, 50.0};
  circle.shape = 1e6 * Eigen::Matrix2d::Identity();
  const std::vector<Eigen::Vector2d> contour = {
      {1100.0, 50.0}, {1103.9, 50.0}, {1104.1, 50.0}, {100.0, -946.1}, {100.0, -945.9}};
  const std::vector<Eigen::Vector2d> gated = GateContour(contour, circle, 2.0);
  ASSERT_EQ(gated.size(), 3u);  // sqrt(3.841) * 2 px = 3.92 px
  EXPECT_EQ(gated[0], contour[0]);
  EXPECT_EQ(gated[1], contour[1]);
  EXPECT_EQ(gated[2], contour[3]);
}

TEST(AlgebraicPointCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kAlgebraicPoint, "algebraic_point", false,
             {ObjectPrimitive::kContour});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kAlgebraicPoint), 3.0 / 20.0, 1e-12);
}

}  // namespace
}  // namespace hullslam
