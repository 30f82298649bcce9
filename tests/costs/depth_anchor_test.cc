// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/depth_anchor.h"

#include <gtest/gtest.h>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

TEST(DepthAnchorCost, ByHand) {
  // Half axes 0.5, 0.2 and 0.1 m around (0, 0, 2).
  SeenEllipsoid state;
  state.ellipsoid.world_from_object.translation = {0.0, 0.0, 2.0};
  state.ellipsoid.half_axes = {0.5, 0.2, 0.1};
  const std::vector<Eigen::Vector3d> points = {
      {0.7, 0.0, 2.0}, {0.0, -0.2, 2.0}, {0.0, 0.0, 1.95}, {0.0, 0.0, 2.0}};
  const DepthAnchorCost cost(points, 0.1);
  EXPECT_LT((ObjectResidualsOf(cost, state) - Eigen::Vector4d(2.0, 0.0, -0.5, -1.0)).norm(), 1e-12);
}

TEST(DepthAnchorCost, IsTheRadialDistanceOfTheEllipsoid) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const Eigen::Vector3d point =
        state.ellipsoid.world_from_object.translation + random.Vector(1.0);
    const std::vector<Eigen::Vector3d> in_camera = {state.cam_from_world * point};
    EXPECT_NEAR(ObjectResidualsOf(DepthAnchorCost(in_camera, 1.0), state)[0],
                state.ellipsoid.RadialDistance(point), 1e-9);
  }
}

TEST(DepthAnchorCost, KeepsTheLaws) {
  RandomGeometry random(2);
  for (int i = 0; i < 30; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const Eigen::Vector3d center =
        state.cam_from_world * state.ellipsoid.world_from_object.translation;
    const std::vector<Eigen::Vector3d> points = {
        center + random.Vector(1.0), center + random.Vector(0.5), center + random.Vector(2.0)};
    ExpectObjectCostLaws(DepthAnchorCost(points, 0.1), state, random);
  }
}

}  // namespace
}  // namespace hullslam
