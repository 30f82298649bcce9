// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/teddy_room.h"

#include <gtest/gtest.h>

#include "synthetic/tests/concavity.h"

namespace hullslam::synthetic {
namespace {

TEST(FurnishTeddyRoom, HasALargeTeddyBearAndOnlyConcaveObjects) {
  SceneBuilder builder(1);
  FurnishTeddyRoom(builder);
  const Scene scene = builder.Finish();
  ASSERT_GE(scene.objects.size(), 9U);
  EXPECT_EQ(scene.objects.front().class_name, "teddy bear");
  EXPECT_GT(scene.objects.front().half_extents.z(), 0.3);
  for (const SceneObject& object : scene.objects) {
    EXPECT_GT(Concavity(object), 0.1) << object.class_name << ' ' << object.id;
  }
}

}  // namespace
}  // namespace hullslam::synthetic
