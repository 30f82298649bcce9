// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/keyframe_order.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

// Keyframes 0 to 3 of the frames 10, 20, 30 and 40, and then of the earlier frames 25 and 15.
class KeyframeOrder : public testing::Test {
 protected:
  KeyframeOrder() {
    for (const uint32_t frame : {10U, 20U, 30U, 40U, 25U, 15U}) {
      Add(frame);
    }
  }
  KeyframeId Add(uint32_t frame, IslandId island = IslandId(0)) {
    const KeyframeId id = map_.AddKeyframe(MakeFrame(frame, 10, 10), Rigid3(), island);
    if (island == IslandId(0) && id != KeyframeId(0)) {
      SetParent(map_, id, KeyframeId(0));
    }
    return id;
  }
  // The frame of the next keyframe of the first island; nothing if there is none.
  std::optional<uint32_t> Next(uint32_t frame, int step) const {
    const Keyframe* const next = NextInTime(map_, FrameId(frame), IslandId(0), step);
    return next != nullptr ? std::optional(next->frame->id.value) : std::nullopt;
  }

  Map map_;
};

TEST_F(KeyframeOrder, IsThatOfFrames) {
  std::vector<uint32_t> frames = {10};
  while (const std::optional<uint32_t> next = Next(frames.back(), 1)) {
    frames.push_back(*next);
  }
  EXPECT_EQ(frames, (std::vector<uint32_t>{10, 15, 20, 25, 30, 40}));
  EXPECT_EQ(Next(10, -1), std::nullopt);
  EXPECT_EQ(Next(12, 1), 15U) << "of a frame without a keyframe";
  EXPECT_EQ(Next(12, -1), 10U);
  for (size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(Next(frames[i], -1), frames[i - 1]);
  }
}

TEST_F(KeyframeOrder, IsThatOfOneIsland) {
  Add(21, IslandId(1));
  Add(24, IslandId(1));
  EXPECT_EQ(Next(20, 1), 25U);
  EXPECT_EQ(Next(25, -1), 20U);
  EXPECT_EQ(NextInTime(map_, FrameId(21), IslandId(1), 1)->frame->id, FrameId(24));
  EXPECT_EQ(NextInTime(map_, FrameId(24), IslandId(1), 1), nullptr);
}

TEST_F(KeyframeOrder, LeavesOutCulledKeyframes) {
  map_.CullKeyframe(KeyframeId(4));
  EXPECT_EQ(Next(20, 1), 30U);
  EXPECT_EQ(FrameIdOf(map_, KeyframeId(4)), FrameId(25));
  EXPECT_EQ(FrameIdOf(map_, KeyframeId(5)), FrameId(15));
}

TEST_F(KeyframeOrder, TheAgeCountsKeyframesThatWereMadeLaterOfLaterFrames) {
  EXPECT_EQ(AgeOf(map_, KeyframeId(1), KeyframeId(1), 9), 0U);
  EXPECT_EQ(AgeOf(map_, KeyframeId(1), KeyframeId(3), 9), 2U);
  EXPECT_EQ(AgeOf(map_, KeyframeId(1), KeyframeId(5), 9), 3U) << "15 is before 20";
  EXPECT_EQ(AgeOf(map_, KeyframeId(3), KeyframeId(5), 9), 0U) << "both are before 40";
  EXPECT_EQ(AgeOf(map_, KeyframeId(4), KeyframeId(5), 9), 0U);
  map_.CullKeyframe(KeyframeId(2));
  EXPECT_EQ(AgeOf(map_, KeyframeId(0), KeyframeId(5), 9), 5U) << "culled ones count";
  EXPECT_EQ(AgeOf(map_, KeyframeId(0), KeyframeId(5), 2), 2U);
}

TEST_F(KeyframeOrder, TheLastObserverIsThatOfTheLatestFrame) {
  const LandmarkId landmark = map_.AddLandmark({0.0, 0.0, 2.0}, KeyframeId(1));
  for (const uint32_t keyframe : {1U, 2U, 4U, 5U}) {
    map_.AddObservation(landmark, KeyframeId(keyframe), 0);
  }
  EXPECT_EQ(LastObserver(map_, map_.landmarks().At(landmark).observations), KeyframeId(2));
}

}  // namespace
}  // namespace hullslam
