// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/relocaliser.h"

#include <gtest/gtest.h>

#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "objects/made_room.h"

namespace hullslam {
namespace {

SystemOptions Options() {
  SystemOptions options;
  options.camera = MakeObjectSensor().camera;
  return options;
}

TEST(RelocaliserTest, NamesTheMethodThatFoundTheFrame) {
  const Sensor sensor = MakeObjectSensor();
  const std::vector<MadeObject> room = MakeRoom();
  Map map;
  AddRoom(map, sensor, room);
  const Relocaliser relocaliser(Options(), std::make_shared<const Map>(map.Snapshot()));
  const Rigid3 truth = CameraOnCircle(0.4, 1.9, 0.7);
  const auto found = relocaliser.Find(SeeRoom(sensor, room, truth));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->method, RelocalisationMethod::kObjects);
  EXPECT_STREQ(ToString(found->method), "objects");
  EXPECT_EQ(found->inliers, 0);
  EXPECT_EQ(found->used_objects, 7);
  EXPECT_LT((found->cam_from_world.translation - truth.translation).norm(), 0.02);
}

TEST(RelocaliserTest, FindsNothingInAnEmptyMap) {
  const Relocaliser relocaliser(Options(), std::make_shared<const Map>());
  EXPECT_FALSE(relocaliser.Find(Frame()));
}

TEST(RelocaliserTest, NeedsAMapAndACamera) {
  EXPECT_THROW(Relocaliser(Options(), nullptr), CheckError);
  EXPECT_THROW(Relocaliser(SystemOptions(), std::make_shared<const Map>()), InputError);
}

}  // namespace
}  // namespace hullslam
