// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/islands.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "map_files/invariants.h"

namespace hullslam {
namespace {

using Keyframes = std::vector<KeyframeId>;

// Three keyframes of one island and then four of another one, each with landmarks and an object.
class IslandsTest : public ::testing::Test {
 protected:
  IslandsTest() {
    first_ = map_.BeginIsland();
    AddKeyframes(first_, 3);
    second_ = map_.BeginIsland();
    AddKeyframes(second_, 4);
  }

  void AddKeyframes(IslandId island, int count) {
    Keyframes added;
    for (int i = 0; i < count; ++i) {
      const uint32_t number = map_.keyframes().NextId().value;
      const Rigid3 pose(Eigen::Quaterniond::Identity(), {0.1 * number, 0.0, 0.0});
      added.push_back(map_.AddKeyframe(MakeFrame(kFramesPerKeyframe * number, 60), pose, island));
    }
    Share(map_, added, 20);
    const ObjectId object = map_.AddObject();
    for (const KeyframeId id : added) {
      UpdateCovisibility(map_, id);
      map_.AddObservation(object, id, 0);
    }
  }
  KeyframeId ParentOf(uint32_t keyframe) const {
    return map_.keyframes().At(KeyframeId(keyframe)).parent;
  }
  void ExpectConsistent() const { EXPECT_EQ(FindViolations(map_), std::vector<std::string>()); }

  Map map_;
  IslandId first_;
  IslandId second_;
};

TEST_F(IslandsTest, HaveTheirOwnKeyframesAndTrees) {
  ExpectConsistent();
  EXPECT_EQ(Islands(map_), (std::vector<IslandId>{first_, second_}));
  EXPECT_LT(first_, second_);
  EXPECT_EQ(KeyframesOf(map_, first_), (Keyframes{KeyframeId(0), KeyframeId(1), KeyframeId(2)}));
  EXPECT_EQ(map_.IslandSize(second_), 4u);
  EXPECT_FALSE(ParentOf(0).IsValid());
  EXPECT_FALSE(ParentOf(3).IsValid());
  EXPECT_EQ(IslandOf(map_, map_.objects().At(ObjectId(1))), second_);
  map_.CullKeyframe(KeyframeId(5));
  EXPECT_EQ(IslandOf(map_, KeyframeId(5)), second_);
  EXPECT_EQ(map_.IslandSize(second_), 3u);
  EXPECT_EQ(map_.islands_begun(), 2u);
  EXPECT_EQ(map_.islands_joined(), 0u);
}

TEST_F(IslandsTest, TheMainOneHasMostKeyframesCulledOnesIncluded) {
  EXPECT_EQ(MainIsland(map_), second_);
  map_.CullKeyframe(KeyframeId(5));
  map_.CullKeyframe(KeyframeId(6));
  EXPECT_EQ(MainIsland(map_), second_);
  AddKeyframes(first_, 1);
  EXPECT_EQ(MainIsland(map_), first_) << "the older one of two equal ones";
  EXPECT_FALSE(MainIsland(Map()).IsValid());
}

TEST_F(IslandsTest, TheMainOneIsThatOfEarlierSessions) {
  Map map;
  map.AddKeyframe(MakeFrame(1, 5), Rigid3(), map.BeginIsland());
  map.BeginSession({.name = "second", .first_frame = map.NextFrame()});
  const IslandId island = map.BeginIsland();
  map.AddKeyframe(MakeFrame(5, 5), Rigid3(), island);
  map.AddKeyframe(MakeFrame(6, 5), Rigid3(), island);
  EXPECT_EQ(MainIsland(map), IslandId(0));
}

// A map may have been saved before its islands were joined.
TEST_F(IslandsTest, TheMainOneOfEarlierSessionsIsTheLargestOne) {
  map_.BeginSession({.name = "second", .first_frame = map_.NextFrame()});
  AddKeyframes(first_, 2);
  EXPECT_EQ(MainIsland(map_), second_) << "earlier sessions made more keyframes of it";
}

TEST_F(IslandsTest, BecomeOneWithOneTree) {
  for (const bool swap : {false, true}) {
    Map before = map_.Snapshot();
    const KeyframeId a(2);
    const KeyframeId b(5);
    JoinIslands(map_, swap ? b : a, swap ? a : b);
    ExpectConsistent();
    EXPECT_EQ(Islands(map_), std::vector<IslandId>{first_});
    EXPECT_EQ(map_.IslandSize(first_), 7u);
    EXPECT_EQ(map_.islands_joined(), 1u);
    EXPECT_FALSE(ParentOf(0).IsValid()) << "the root of the older island stays";
    EXPECT_EQ(ParentOf(5), a);
    for (uint32_t i = 1; i < 7; ++i) {
      EXPECT_TRUE(ParentOf(i).IsValid()) << i;
      EXPECT_EQ(map_.CamFromWorld(KeyframeId(i)).translation,
                before.CamFromWorld(KeyframeId(i)).translation);
    }
    JoinIslands(map_, KeyframeId(0), KeyframeId(6));
    EXPECT_EQ(map_.islands_joined(), 1u) << "the islands were joined before";
    EXPECT_EQ(ParentOf(5), a);
    map_ = before.Snapshot();
    EXPECT_EQ(Islands(map_).size(), 2u) << "a snapshot has islands of its own";
  }
}

TEST_F(IslandsTest, RemovedIslandsLeaveOnlyTheNumbersOfTheirFrames) {
  map_.CullKeyframe(KeyframeId(4));
  EXPECT_TRUE(KeepOnlyIsland(map_, first_));
  ExpectConsistent();
  EXPECT_EQ(Islands(map_), std::vector<IslandId>{first_});
  EXPECT_EQ(map_.keyframes().size(), 3u);
  EXPECT_EQ(map_.landmarks().size(), 20u);
  EXPECT_EQ(map_.objects().size(), 1u);
  for (uint32_t i = 3; i < 7; ++i) {
    EXPECT_FALSE(map_.NearestAlive(KeyframeId(i)).IsValid());
    EXPECT_FALSE(IslandOf(map_, KeyframeId(i)).IsValid());
    EXPECT_EQ(map_.KeyframeOfFrame(FrameId(kFramesPerKeyframe * i)), KeyframeId(i));
  }
  EXPECT_EQ(map_.NextFrame(), FrameId(6 * kFramesPerKeyframe + 1));
  EXPECT_FALSE(KeepOnlyIsland(map_, first_)) << "there is only one";
}

}  // namespace
}  // namespace hullslam
