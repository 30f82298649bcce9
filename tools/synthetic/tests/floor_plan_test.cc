// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/floor_plan.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "synthetic/ray_caster.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Two rooms side by side. The doorway between them is at x = 0, y = 0.5.
Scene TwoRooms() {
  SceneBuilder builder(1);
  const Palette palette = builder.AddBarePalette();
  const std::array<Doorway, 1> doorways = {{{.centre = {0.0, 0.5}}}};
  AddChamber({.min = {-3.1, -1.0}, .max = {-0.1, 2.0}}, doorways, palette, builder);
  AddChamber({.min = {0.1, -1.0}, .max = {4.1, 2.0}}, doorways, palette, builder);
  return builder.Finish();
}

double Distance(const RayCaster& caster, const Vector3d& eye, const Vector3d& direction) {
  RayPacket packet;
  packet.direction.fill(direction.normalized().cast<float>());
  caster.Cast(eye.cast<float>(), {}, packet);
  return packet.distance.front();
}

TEST(FloorPlan, ADoorwayIsTheOnlyWayFromRoomToRoom) {
  const Scene scene = TwoRooms();
  const RayCaster caster(scene);
  const Vector3d eye(-2.1, 0.5, 1.4);
  EXPECT_NEAR(Distance(caster, eye, Vector3d::UnitX()), 6.2, 1e-5);
  EXPECT_NEAR(Distance(caster, eye, -Vector3d::UnitX()), 1.0, 1e-5);
  EXPECT_NEAR(Distance(caster, eye, Vector3d::UnitY()), 1.5, 1e-5);
  EXPECT_NEAR(Distance(caster, eye, Vector3d::UnitZ()), kChamberHeight - 1.4, 1e-5);
  EXPECT_NEAR(Distance(caster, eye, -Vector3d::UnitZ()), 1.4, 1e-5);
  // Rays that pass beside the doorway or above it hit the wall.
  EXPECT_NEAR(Distance(caster, {-2.1, 1.05, 1.4}, Vector3d::UnitX()), 2.0, 1e-5);
  EXPECT_NEAR(Distance(caster, {-2.1, -0.05, 1.4}, Vector3d::UnitX()), 2.0, 1e-5);
  EXPECT_NEAR(Distance(caster, {-2.1, 0.5, 2.15}, Vector3d::UnitX()), 2.0, 1e-5);
  EXPECT_NEAR(Distance(caster, {-2.1, 0.95, 2.05}, Vector3d::UnitX()), 6.2, 1e-5);
}

TEST(FloorPlan, NoRayLeavesTheHouse) {
  const Scene scene = TwoRooms();
  const RayCaster caster(scene);
  RandomStream random(2);
  for (int i = 0; i < 3000; ++i) {
    const double x = random.Uniform(-1.0, 1.0);
    const double y = random.Uniform(-1.0, 1.0);
    const double z = random.Uniform(-1.0, 1.0);
    const double distance = Distance(caster, {-0.3, 0.6, 1.2}, {x, y, z});
    ASSERT_LT(distance, 8.0) << x << " " << y << " " << z;
  }
}

TEST(FloorPlan, ObjectsCanStandOnTheFloors) {
  const Scene scene = TwoRooms();
  ASSERT_EQ(scene.supports.size(), 2U);
  EXPECT_EQ(scene.supports[1].min, Eigen::Vector2d(0.1, -1.0));
  EXPECT_EQ(scene.supports[1].max, Eigen::Vector2d(4.1, 2.0));
  EXPECT_EQ(scene.supports[1].height, 0.0);
}

TEST(FloorPlan, PostersHangOnTheWallsBesideTheDoorway) {
  SceneBuilder builder(1);
  Palette palette = builder.AddBarePalette();
  const std::array<Doorway, 1> doorways = {{{.centre = {0.0, 0.5}}}};
  const Chamber chamber{.min = {-3.1, -1.0}, .max = {-0.1, 2.0}};
  AddChamber(chamber, doorways, palette, builder);
  const size_t without = builder.scene().background.size();
  palette.posters = {palette.keys};
  AddChamber(chamber, doorways, palette, builder);
  const Scene scene = builder.Finish();
  EXPECT_GE(scene.background.size(), 2 * without + 4);
  int posters = 0;
  for (const Part& part : scene.background) {
    const Vector3d& at = part.owner_from_part.translation;
    if (part.shape.half.y() == 0.008) {
      ++posters;
      EXPECT_GT(std::abs(at.x() + 0.108) + std::abs(at.y() - 0.5), 0.5);
    }
  }
  EXPECT_GE(posters, 4);
}

}  // namespace
}  // namespace hullslam::synthetic
