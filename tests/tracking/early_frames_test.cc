// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/early_frames.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
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
    early_.Keep(world_.Observe(i).frame, false);
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

// In the first one most of what the map has is outside the image; the second one shows nothing new.
TEST_F(EarlyFramesTest, AFrameThatShowsANewPartBecomesAKeyframe) {
  const Rigid3 aside =
      Rigid3(ExpSo3({0.0, 0.65, 0.0}), Eigen::Vector3d::Zero()) * SyntheticWorld::CamFromWorld(14);
  early_.Keep(world_.Observe(FrameId(14), aside).frame, false);
  early_.Keep(world_.Observe(3).frame, false);
  const SyntheticMap made = MakeSyntheticMap(world_, {2, 5, 12});
  const std::optional<KeyframeRequest> request = early_.FindKeyframe(made.map, Context());
  ASSERT_TRUE(request);
  EXPECT_EQ(request->frame->id, FrameId(14));
  const Rigid3 found = made.map.CamFromWorld(request->pose);
  EXPECT_LT((found.translation - aside.translation).norm(), 0.02);
  EXPECT_LT(AngularDistance(found.rotation, aside.rotation), 0.01);
  EXPECT_FALSE(early_.FindKeyframe(made.map, Context())) << "there is nothing new to compare with";
  EXPECT_EQ(early_.Localise(made.map, Context()).size(), 2u) << "they still get poses at the end";
}

TEST_F(EarlyFramesTest, AreForgottenOnceTheyAreLocalised) {
  early_.Keep(world_.Observe(1).frame, false);
  const SyntheticMap made = MakeSyntheticMap(world_, {2, 5, 12});
  EXPECT_EQ(early_.Localise(made.map, Context()).size(), 1u);
  EXPECT_TRUE(early_.Localise(made.map, Context()).empty());
}

TEST_F(EarlyFramesTest, AreLeftOutOnceItIsCancelled) {
  for (uint32_t i = 0; i < 8; ++i) {
    early_.Keep(world_.Observe(i).frame, false);
  }
  const SyntheticMap made = MakeSyntheticMap(world_, {2, 5, 12});
  Cancellation cancellation;
  int last = 0;
  const std::vector<TrackedFrame> found =
      early_.Localise(made.map, Context(), &cancellation, [&](int done, int most) {
        last = done;
        EXPECT_EQ(most, 8);
        if (done == 3) {
          cancellation.Request();
        }
      });
  EXPECT_EQ(last, 3);
  EXPECT_EQ(found.size(), 3u);
  EXPECT_TRUE(early_.Localise(made.map, Context()).empty()) << "all are forgotten";
}

TEST_F(EarlyFramesTest, AreLeftOutWhereTheMapDoesNotShowThem) {
  early_.Keep(world_.Observe(1).frame, false);
  const SyntheticWorld other({.points = 300, .depth_share = 0.0, .seed = 77});
  const SyntheticMap made = MakeSyntheticMap(other, {2, 12});
  EXPECT_TRUE(early_.Localise(made.map, Context()).empty());
}

// Two images of a point differ so much that only a search near its expected pixel finds it. A car
// sees the landmarks of its first map like this from far behind.
TEST_F(EarlyFramesTest, AreTrackedBackFromTheFrameAfterThem) {
  const SyntheticWorld world({.points = 300, .depth_share = 0.0, .flipped_bits = 40});
  for (uint32_t i = 0; i < 13; ++i) {
    early_.Keep(world.Observe(i).frame, false);
  }
  const SyntheticMap made = MakeSyntheticMap(world, {8, 10, 12});
  const std::vector<TrackedFrame> found = early_.Localise(made.map, Context());
  ASSERT_EQ(found.size(), 13u);
  for (uint32_t i = 0; i < 13; ++i) {
    EXPECT_EQ(found[i].frame, FrameId(i));
    if (i < 8) {
      ASSERT_TRUE(found[i].from_keyframe) << i;
      const Rigid3 error =
          made.map.CamFromWorld(*found[i].from_keyframe) * Inverse(SyntheticWorld::CamFromWorld(i));
      EXPECT_LT(error.translation.norm(), 0.02) << i;
      EXPECT_GE(found[i].inliers, 30) << i;
    }
  }
}

// A frame that was not kept, or is not found, ends the way back.
TEST_F(EarlyFramesTest, AreNotTrackedBackOverAGap) {
  const SyntheticWorld world({.points = 300, .depth_share = 0.0, .flipped_bits = 40});
  for (const uint32_t i : {0U, 4U, 6U, 7U, 8U}) {
    early_.Keep(world.Observe(i).frame, false);
  }
  const SyntheticMap made = MakeSyntheticMap(world, {8, 10, 12});
  const std::vector<TrackedFrame> found = early_.Localise(made.map, Context());
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found.front().frame, FrameId(6));
}

// The time stamps of another session may be the same although it was elsewhere.
TEST_F(EarlyFramesTest, AreSoughtAtTheKeyframesOfTheirSession) {
  SyntheticMap made = MakeSyntheticMap(world_, {2, 5});
  made.map.BeginSession({.name = "second", .first_frame = FrameId(100)});
  const SyntheticWorld other({.points = 300, .depth_share = 0.0, .seed = 77});
  const SyntheticView view = other.Observe(60);
  auto keyframe = std::make_shared<Frame>(*view.frame);
  keyframe->id = FrameId(110);
  keyframe->timestamp = 100.0;
  const KeyframeId added = made.map.AddKeyframe(keyframe, SyntheticWorld::CamFromWorld(60));
  for (uint32_t i = 0; i < view.points.size(); ++i) {
    const LandmarkId landmark = made.map.AddLandmark(other.points()[view.points[i]], added);
    made.map.AddObservation(landmark, added, i);
    UpdateDescriptor(made.map, landmark);
    UpdateViewingGeometry(made.map, landmark, sensor_.levels);
  }
  auto early = std::make_shared<Frame>(*other.Observe(61).frame);
  early->id = FrameId(101);
  early->timestamp = made.map.keyframes().At(KeyframeId(0)).frame->timestamp;
  early_.Keep(early, false);
  const std::vector<TrackedFrame> found = early_.Localise(made.map, Context());
  ASSERT_EQ(found.size(), 1u);
  const Rigid3 truth = SyntheticWorld::CamFromWorld(61);
  EXPECT_LT((found[0].cam_from_world.translation - truth.translation).norm(), 0.02);
}

// Only words or objects can find a frame in the map of an earlier session, not its time stamp.
TEST_F(EarlyFramesTest, AreNotSoughtByTimeInAnEarlierSession) {
  SyntheticMap made = MakeSyntheticMap(world_, {2, 5});
  made.map.BeginSession({.name = "second", .first_frame = FrameId(100)});
  auto early = std::make_shared<Frame>(*world_.Observe(3).frame);
  early->id = FrameId(101);
  early_.Keep(early, false);
  EXPECT_TRUE(early_.Localise(made.map, Context()).empty());
}

TEST_F(EarlyFramesTest, TheOldestAreForgottenIfThereAreTooMany) {
  const std::shared_ptr<const Frame> seen = world_.Observe(2).frame;
  for (uint32_t i = 0; i < 305; ++i) {
    auto frame = std::make_shared<Frame>(*seen);
    frame->id = FrameId(i + 1000);
    early_.Keep(std::move(frame), false);
  }
  const SyntheticMap made = MakeSyntheticMap(world_, {5, 12});
  const std::vector<TrackedFrame> found = early_.Localise(made.map, Context());
  ASSERT_EQ(found.size(), 300u);
  EXPECT_EQ(found.front().frame, FrameId(1005));
}

// The camera stands still after a few frames, while its island is young.
TEST_F(EarlyFramesTest, TrackedOnesAreForgottenBeforeThoseWithoutAPose) {
  const std::shared_ptr<const Frame> seen = world_.Observe(2).frame;
  for (uint32_t i = 0; i < 340; ++i) {
    auto frame = std::make_shared<Frame>(*seen);
    frame->id = FrameId(i + 1000);
    early_.Keep(std::move(frame), i >= 20);
  }
  const SyntheticMap made = MakeSyntheticMap(world_, {5, 12});
  const std::vector<TrackedFrame> found = early_.Localise(made.map, Context());
  ASSERT_EQ(found.size(), 300u);
  EXPECT_EQ(found.front().frame, FrameId(1000));
  EXPECT_EQ(found[19].frame, FrameId(1019));
  EXPECT_EQ(found[20].frame, FrameId(1060)) << "the oldest tracked ones are missing";
}

TEST(IslandRules, WithDepthOneFrameMakesAnIslandAfterAWait) {
  const IslandRules rules = IslandRules::ForSensor(SensorKind::kRgbd);
  EXPECT_FALSE(rules.needs_motion);
  EXPECT_FALSE(rules.begins_at_once);
}

TEST(IslandRules, AMonocularCameraNeedsMotionInsteadOfAWait) {
  const IslandRules rules = IslandRules::ForSensor(SensorKind::kMonocular);
  EXPECT_TRUE(rules.needs_motion);
  EXPECT_TRUE(rules.begins_at_once);
}

}  // namespace
}  // namespace hullslam
