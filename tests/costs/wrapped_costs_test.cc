// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/wrapped_costs.h"

#include <ceres/loss_function.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "costs/object_cost_laws.h"
#include "costs/quadric_tangent.h"

namespace hullslam {
namespace {

// Three lines whose distances to the sphere's projected ellipse (x from -55 to 695) are 0, 1 and
// 16 px.
std::unique_ptr<TangentCost> ThreeLines() {
  const std::vector<SilhouetteLine> lines = {
      {{{1.0, 0.0}, -695.0}, false}, {{{1.0, 0.0}, -694.0}, false}, {{{-1.0, 0.0}, -71.0}, false}};
  return std::make_unique<TangentCost>(kObjectCamera, lines, 1.0);
}

// Huber's loss with parameter 4 turns 16^2 into 2 * 4 * 16 - 4^2 = 112.
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

// Near the minimum, residuals can be as small as rounding errors.
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

constexpr double kBaseline = 0.2;  // m

// The object as the right camera sees it.
SeenEllipsoid InRight(SeenEllipsoid state) {
  state.cam_from_world.translation.x() -= kBaseline;
  return state;
}

BothViewsCost Tangents(const std::vector<SilhouetteLine>& left,
                       const std::vector<SilhouetteLine>& right) {
  return {std::make_unique<TangentCost>(kObjectCamera, left, 2.0),
          std::make_unique<TangentCost>(kObjectCamera, right, 2.0), kBaseline};
}

// A small sphere 2 m ahead appears f b / z = 50 px further left in the right image.
TEST(BothViewsCost, ByHand) {
  SeenEllipsoid state;
  state.ellipsoid.world_from_object.translation = {0.0, 0.0, 2.0};
  state.ellipsoid.half_axes.setConstant(1e-4);
  const BothViewsCost cost =
      Tangents({{{{1.0, 0.0}, -320.0}, false}}, {{{{1.0, 0.0}, -260.0}, false}});
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, state);
  ASSERT_EQ(residuals.size(), 2);
  EXPECT_NEAR(residuals[0], 0.0, 0.02);
  EXPECT_NEAR(residuals[1], 5.0, 0.02);  // (320 - 50 - 260) / 2
}

TEST(BothViewsCost, IsZeroForTheTangentsOfBothImages) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const BothViewsCost cost = Tangents(TangentsOf(state, 8), TangentsOf(InRight(state), 12));
    EXPECT_EQ(cost.num_residuals(), 20);
    EXPECT_LT(ObjectResidualsOf(cost, state).norm(), 1e-7);
  }
}

TEST(BothViewsCost, KeepsTheLaws) {
  RandomGeometry random(3);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const BothViewsCost cost = Tangents(TangentsOf(RandomSeenEllipsoid(random), 4),
                                        TangentsOf(RandomSeenEllipsoid(random), 4));
    ExpectTrueObjectGradient(cost, state);
    ExpectObjectRigidInvariance(cost, state, random.Pose(1.0, 2.0));
  }
}

TEST(BothViewsCost, IsNotDefinedUnlessInFront) {
  const std::vector<SilhouetteLine> lines = {{{{1.0, 0.0}, -320.0}, false}};
  ExpectUndefinedUnlessInFront(Tangents(lines, lines));
}

}  // namespace
}  // namespace hullslam
