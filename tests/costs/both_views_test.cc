// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/both_views.h"

#include <gtest/gtest.h>

#include <memory>

#include "costs/object_cost_laws.h"
#include "costs/quadric_tangent.h"

namespace hullslam {
namespace {

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
