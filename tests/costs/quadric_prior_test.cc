// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/quadric_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

Eigen::Matrix<double, 9, 1> PriorOf(const QuadricPriorCost& cost, const Ellipsoid& ellipsoid) {
  const ObjectBlocks blocks({{}, ellipsoid});
  const double* parameters[] = {blocks.object.data(), blocks.log_axes.data()};
  Eigen::Matrix<double, 9, 1> residuals;
  EXPECT_TRUE(cost.Evaluate(parameters, residuals.data(), nullptr));
  return residuals;
}

Ellipsoid Start() {
  Ellipsoid start;
  start.world_from_object = {ExpSo3({0.3, -0.2, 0.5}), {1.0, 2.0, 3.0}};
  start.half_axes = {0.8, 0.4, 0.2};  // of size 0.4
  return start;
}

TEST(QuadricPriorCost, IsZeroAtTheStart) {
  EXPECT_LT(PriorOf(QuadricPriorCost(Start()), Start()).norm(), 1e-12);
}

TEST(QuadricPriorCost, ByHand) {
  Ellipsoid moved = Start();
  moved.half_axes.z() *= std::exp(1.0);
  moved.world_from_object.translation.y() += 0.2;
  const double angle = std::numbers::pi / 3.0;
  moved.world_from_object.rotation = ExpSo3({0.0, 0.0, angle}) * moved.world_from_object.rotation;
  const QuadricPriorCost cost(Start(), {.log_axes = 0.5, .center = 0.25, .rotation = 0.1});
  Eigen::Matrix<double, 9, 1> expected;
  expected << 0.0, 0.0, 2.0, 0.0, 2.0, 0.0, 0.0, 0.0, 10.0;
  EXPECT_LT((PriorOf(cost, moved) - expected).norm(), 1e-9);
}

// A quaternion and its negative are one rotation.
TEST(QuadricPriorCost, DoesNotDependOnTheSignOfTheQuaternion) {
  Ellipsoid moved = Start();
  moved.world_from_object.rotation = ExpSo3({0.1, 0.2, 0.3}) * moved.world_from_object.rotation;
  const QuadricPriorCost cost(Start());
  const Eigen::Matrix<double, 9, 1> before = PriorOf(cost, moved);
  moved.world_from_object.rotation.coeffs() *= -1.0;
  EXPECT_LT((PriorOf(cost, moved) - before).norm(), 1e-12);
}

TEST(QuadricPriorCost, GradientIsTrue) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const QuadricPriorCost cost(RandomSeenEllipsoid(random).ellipsoid);
    const ObjectBlocks blocks(RandomSeenEllipsoid(random));
    ExpectTrueGradientAt(cost, {blocks.object}, blocks.log_axes, 1e-7);
  }
}

}  // namespace
}  // namespace hullslam
