// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/early_frames.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "objects/object_index.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// Frames without depth of a moving camera.
class EarlyFramesTest : public testing::Test {
 protected:
  EarlyFramesTest() { sensor_.kind = SensorKind::kMonocular; }
  TrackingContext Context() const { return {sensor_, options_, objects_, index_}; }

  const SyntheticWorld world_{{.points = 300, .depth_share = 0.0}};
  Sensor sensor_ = world_.sensor();
  const TrackingOptions options_;
  const ObjectOptions objects_;
  const ObjectIndex index_;
  EarlyFrames early_;
};

TEST_F(EarlyFramesTest, GetPosesInTheFinalMap) {
  for (uint32_t i = 0; i < 8; ++i) {
    early_.Keep(world_.Observe(i).frame);
  }
  const SyntheticMap made = MakeSyntheticMap(world_, {2, 5, 12});
  const std::vector<TrackedFrame> found = early_.Localise(made.map, Context());
  ASSERT_EQ(found.size(), 8u);
  for (uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(found[i].frame, FrameId(i));
    EXPECT_EQ(found[i].state, TrackingState::kTracked);
    if (i == 2 || i == 5) {
      EXPECT_FALSE(found[i].from_keyframe) << "it is a keyframe";
    } else {
      ASSERT_TRUE(found[i].from_keyframe) << i;
      const Rigid3 truth = SyntheticWorld::CamFromWorld(i);
      EXPECT_LT(
          (made.map.CamFromWorld(*found[i].from_keyframe).translation - truth.translation).norm(),
          0.02);
    }
  }
}

TEST_F(EarlyFramesTest, AreForgottenOnceTheyAreLocalised) {
  early_.Keep(world_.Observe(1).frame);
  const SyntheticMap made = MakeSyntheticMap(world_, {2, 5, 12});
  EXPECT_EQ(early_.Localise(made.map, Context()).size(), 1u);
  EXPECT_TRUE(early_.Localise(made.map, Context()).empty());
}

TEST_F(EarlyFramesTest, AreLeftOutWhereTheMapDoesNotShowThem) {
  early_.Keep(world_.Observe(1).frame);
  const SyntheticWorld other({.points = 300, .depth_share = 0.0, .seed = 77});
  const SyntheticMap made = MakeSyntheticMap(other, {2, 12});
  EXPECT_TRUE(early_.Localise(made.map, Context()).empty());
}

TEST_F(EarlyFramesTest, TheOldestAreForgottenIfThereAreTooMany) {
  const std::shared_ptr<const Frame> seen = world_.Observe(2).frame;
  for (uint32_t i = 0; i < 305; ++i) {
    auto frame = std::make_shared<Frame>(*seen);
    frame->id = FrameId(i + 1000);
    early_.Keep(std::move(frame));
  }
  const SyntheticMap made = MakeSyntheticMap(world_, {5, 12});
  const std::vector<TrackedFrame> found = early_.Localise(made.map, Context());
  ASSERT_EQ(found.size(), 300u);
  EXPECT_EQ(found.front().frame, FrameId(1005));
}

TEST(IslandRules, WithDepthOneFrameMakesTheOnlyIsland) {
  const IslandRules rules = IslandRules::ForSensor(SensorKind::kRgbd);
  EXPECT_FALSE(rules.needs_motion);
  EXPECT_FALSE(rules.begins_when_lost);
}

TEST(IslandRules, AMonocularCameraNeedsMotionAndGoesOnWhenLost) {
  const IslandRules rules = IslandRules::ForSensor(SensorKind::kMonocular);
  EXPECT_TRUE(rules.needs_motion);
  EXPECT_TRUE(rules.begins_when_lost);
}

}  // namespace
}  // namespace hullslam
