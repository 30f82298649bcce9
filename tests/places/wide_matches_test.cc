// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/wide_matches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/ring_world.h"

namespace hullslam {
namespace {

class WideMatches : public testing::TestWithParam<bool> {
 protected:
  const RingWorld& world_ = SharedRing();
  RingMap made_ =
      MakeRingMap(world_, {.keyframes = 24, .drift = Rigid3(), .has_vocabulary = GetParam()});
};

INSTANTIATE_TEST_SUITE_P(Vocabulary, WideMatches, testing::Bool());

// Keyframe k is frame 3 k.
TEST_P(WideMatches, KeyframesNearInTimeComeFirst) {
  const SyntheticView view = world_.Observe(FrameId(31), RingWorld::CamFromWorld(0.0));
  const std::vector<KeyframeId> keyframes = KeyframesForWideMatches(made_.map, *view.frame);
  ASSERT_GE(keyframes.size(), 10u);
  EXPECT_EQ(std::vector(keyframes.begin(), keyframes.begin() + 4),
            (std::vector{KeyframeId(10), KeyframeId(11), KeyframeId(9), KeyframeId(12)}));
  EXPECT_EQ(std::set(keyframes.begin(), keyframes.end()).size(), keyframes.size());
  const bool has_similar =
      std::find(keyframes.begin(), keyframes.end(), KeyframeId(0)) != keyframes.end();
  EXPECT_EQ(has_similar, GetParam()) << "only words tell of it";
}

TEST_P(WideMatches, KeyframesOfAnIslandCanBeLeftOut) {
  const IslandId other = made_.map.BeginIsland();
  made_.map.MoveToIsland(KeyframeId(11), other);
  const SyntheticView view = world_.Observe(FrameId(31), RingWorld::CamFromWorld(0.0));
  EXPECT_EQ(KeyframesForWideMatches(made_.map, *view.frame,
                                    made_.map.keyframes().At(KeyframeId(0)).island),
            std::vector{KeyframeId(11)});
}

// 40 degrees and 0.55 m away.
TEST_P(WideMatches, LandmarksAreFoundWhereverTheyAreInTheImage) {
  const SyntheticView view = world_.Observe(FrameId(1000), RingWorld::CamFromWorld(8.7 / 24.0));
  const std::vector<FoundLandmark> found = MatchLandmarksOf(made_.map, *view.frame, KeyframeId(6));
  EXPECT_GT(found.size(), 20u);
  for (const auto& [keypoint, landmark] : found) {
    const Observation& seen = made_.map.landmarks().At(landmark).observations.front();
    EXPECT_EQ(made_.views[seen.keyframe.value].points[seen.keypoint], view.points[keypoint]);
  }
  EXPECT_TRUE(MatchLandmarksOf(made_.map, *view.frame, KeyframeId(20)).empty());
}

}  // namespace
}  // namespace hullslam
