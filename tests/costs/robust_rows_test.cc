// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/robust_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "costs/object_cost_laws.h"
#include "costs/quadric_tangent.h"

namespace hullslam {
namespace {

// Three lines that the sphere's outline (x from -55 to 695) misses by 0, 1 and 16 px.
std::unique_ptr<TangentCost> ThreeLines() {
  const std::vector<SilhouetteLine> lines = {
      {{{1.0, 0.0}, -695.0}, false}, {{{1.0, 0.0}, -694.0}, false}, {{{-1.0, 0.0}, -71.0}, false}};
  return std::make_unique<TangentCost>(kObjectCamera, lines, 1.0);
}

// Huber's loss at 4 makes of 16^2 2 * 4 * 16 - 4^2 = 112.
TEST(RobustRowsCost, ByHand) {
  const RobustRowsCost cost(ThreeLines(), std::make_unique<ceres::HuberLoss>(4.0), 0.25);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, SphereAhead());
  EXPECT_NEAR(residuals[0], 0.0, 1e-9);
  EXPECT_NEAR(residuals[1], 0.5, 1e-9);
  EXPECT_NEAR(residuals[2], -0.5 * std::sqrt(112.0), 1e-9);
}

TEST(RobustRowsCost, WithoutLossOnlyWeighs) {
  const RobustRowsCost cost(ThreeLines(), nullptr, 4.0);
  const Eigen::VectorXd plain = ObjectResidualsOf(cost.plain(), SphereAhead());
  EXPECT_LT((ObjectResidualsOf(cost, SphereAhead()) - 2.0 * plain).norm(), 1e-12);
}

// The sum of the squares that Ceres sees is that of CostOf, and WeightOf is its slope.
TEST(RobustRowsCost, TellsTheCostAndTheWeightOfAResidual) {
  const RobustRowsCost cost(ThreeLines(), std::make_unique<ceres::HuberLoss>(4.0), 0.25);
  EXPECT_NEAR(cost.CostOf(16.0), 0.25 * 112.0, 1e-9);
  EXPECT_NEAR(cost.CostOf(-1.0), 0.25, 1e-9);
  EXPECT_NEAR(cost.WeightOf(16.0), 0.25 * 4.0 / 16.0, 1e-9);
  EXPECT_NEAR(cost.WeightOf(1.0), 0.25, 1e-9);
  EXPECT_EQ(RobustRowsCost(ThreeLines(), nullptr, 2.0).WeightOf(100.0), 2.0);
}

TEST(RobustRowsCost, KeepsTheLaws) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const RobustRowsCost cost(std::make_unique<TangentCost>(
                                  kObjectCamera, TangentsOf(RandomSeenEllipsoid(random), 12), 5.0),
                              std::make_unique<ceres::CauchyLoss>(2.5), 0.3);
    ExpectObjectCostLaws(cost, state, random);
  }
}

// Near the minimum residuals are as small as rounding leaves them.
TEST(RobustRowsCost, IsTheCostItselfForTinyResiduals) {
  for (const double error : {1e-3, 1e-5, 1e-7, 3e-9, 1e-12, 0.0}) {
    const std::vector<SilhouetteLine> lines = {{{{1.0, 0.0}, -695.0 + error}, false}};
    const RobustRowsCost cost(std::make_unique<TangentCost>(kObjectCamera, lines, 1.0),
                              std::make_unique<ceres::CauchyLoss>(2.5), 1.0);
    ExpectTrueObjectGradient(cost, SphereAhead());
    const double plain = ObjectResidualsOf(cost.plain(), SphereAhead())[0];
    EXPECT_NEAR(ObjectResidualsOf(cost, SphereAhead())[0], plain, 1e-6 * plain);
  }
}

TEST(RobustRowsCost, IsNotDefinedWhereTheCostIsNot) {
  ExpectUndefinedUnlessInFront(RobustRowsCost(ThreeLines(), nullptr, 1.0));
}

}  // namespace
}  // namespace hullslam
