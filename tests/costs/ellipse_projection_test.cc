// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/ellipse_projection.h"

#include <gtest/gtest.h>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

class NumbersCost final : public ObjectCost {
 public:
  NumbersCost() : ObjectCost(5) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const QuadricInCamera quadric(parameters);
    EllipseProjection ellipse(kObjectCamera, quadric);
    ellipse.Linearize();
    Eigen::Map<EllipseNumbers>(residuals, 5) = ellipse.numbers();
    for (int row = 0; jacobians != nullptr && row < 5; ++row) {
      ellipse.WriteRow(row, ByEllipse::Unit(row), jacobians);
    }
    return true;
  }
};

TEST(EllipseProjection, ByHand) {
  const ObjectBlocks blocks(SphereAhead());
  const QuadricInCamera quadric(blocks.Pointers().data());
  const EllipseProjection ellipse(kObjectCamera, quadric);
  EllipseNumbers expected;
  expected << 320.0, 240.0, 375.0 * 375.0, 0.0, 300.0 * 300.0;
  EXPECT_LT((ellipse.numbers() - expected).norm(), 1e-7);
  EXPECT_TRUE(ellipse.HasArea());
}

TEST(EllipseProjection, PassesThroughTheTangentRays) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const ObjectBlocks blocks(state);
    const QuadricInCamera quadric(blocks.Pointers().data());
    const EllipseProjection ellipse(kObjectCamera, quadric);
    for (const Eigen::Vector2d& point : ContourOf(state, 12)) {
      const Eigen::Vector2d from_center = point - ellipse.center();
      EXPECT_NEAR(from_center.dot(ellipse.shape().inverse() * from_center), 1.0, 1e-9);
    }
  }
}

TEST(EllipseProjection, DerivativeIsTrue) {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    ExpectObjectCostLaws(NumbersCost(), RandomSeenEllipsoid(random), random);
  }
}

TEST(EllipseNumbers, LeadBackToTheEllipse) {
  Ellipse ellipse;
  ellipse.center = {1.0, 2.0};
  ellipse.shape << 9.0, 1.0, 1.0, 4.0;
  const Ellipse same = ToEllipse(ToNumbers(ellipse));
  EXPECT_EQ(same.center, ellipse.center);
  EXPECT_EQ(same.shape, ellipse.shape);
}

}  // namespace
}  // namespace hullslam
