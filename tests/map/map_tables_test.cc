// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/map_tables.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "map/made_map.h"

namespace hullslam {
namespace {

TEST(MapTables, AMapOfTablesHasWhatIsInThem) {
  MapTables tables;
  Keyframe keyframe;
  keyframe.frame = MakeFrame(3, 5);
  tables.keyframes.Put(KeyframeId(1), keyframe);
  CulledKeyframe culled;
  culled.pose.reference = KeyframeId(1);
  tables.culled.Put(KeyframeId(0), culled);
  Landmark landmark;
  landmark.position = {1.0, 2.0, 3.0};
  tables.landmarks.Put(LandmarkId(4, 2), landmark);
  ObjectLandmark object;
  object.misfit_px = 2.0;
  tables.objects.Put(ObjectId(6), object);
  tables.sessions = {{"first", FrameId(0)}};
  tables.correction_count = 9;
  const Map map(std::move(tables));
  EXPECT_EQ(map.keyframes().At(KeyframeId(1)).frame->id, FrameId(3));
  EXPECT_EQ(map.FindCulled(KeyframeId(0))->pose.reference, KeyframeId(1));
  EXPECT_EQ(map.landmarks().At(LandmarkId(4, 2)).position.z(), 3.0);
  EXPECT_EQ(map.objects().At(ObjectId(6)).misfit_px, 2.0);
  EXPECT_EQ(map.sessions().front().name, "first");
  EXPECT_EQ(map.correction_count(), 9u);
  EXPECT_EQ(map.revision(), 0u);
}

TEST(Session, AFrameBelongsToTheLastSessionThatHadBegun) {
  const std::vector<Session> sessions = {{"a", FrameId(2)}, {"b", FrameId(5)}, {"c", FrameId(9)}};
  const std::vector<size_t> expected = {0, 0, 1, 1, 1, 2, 2, 2, 2, 3, 3};
  for (uint32_t frame = 0; frame < expected.size(); ++frame) {
    EXPECT_EQ(SessionNumber(sessions, FrameId(frame)), expected[frame]) << frame;
  }
  EXPECT_EQ(SessionNumber({}, FrameId(7)), 0u);
}

}  // namespace
}  // namespace hullslam
