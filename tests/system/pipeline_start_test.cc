// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <utility>

#include "hullslam/map_files/map_file.h"
#include "map/invariants.h"
#include "map/made_map.h"
#include "support/ring_world.h"
#include "support/temporary_folder.h"
#include "system/compose_trajectory.h"
#include "system/pipeline.h"

namespace hullslam {
namespace {

constexpr uint32_t kFrames = 25;  // of a session

// Walks through the ring world.
class PipelineStartTest : public testing::TestWithParam<bool> {
 protected:
  PipelineStartTest() { options_.vocabulary = world_.vocabulary(); }

  std::unique_ptr<Pipeline> MakePipeline() const {
    return GetParam() ? MakeThreadedPipeline(world_.sensor(), options_, Pace::kWaitForMapper)
                      : MakeSequentialPipeline(world_.sensor(), options_);
  }

  // The map of a first session along the first sixth of the circle.
  Map FirstSession() const {
    const TemporaryFolder folder;
    const auto pipeline = MakeSequentialPipeline(world_.sensor(), options_);
    pipeline->Begin({.session = {.name = "first", .first_frame = FrameId(0)}});
    Track(*pipeline, FrameId(0), Walk(0));
    pipeline->Finish();
    SystemOptions options = options_;
    options.camera = world_.sensor().camera;
    WriteMap(folder.path() / "map", *pipeline->map(), MapSettingsOf(options));
    return ReadMap(folder.path() / "map", options);
  }

  // The poses of kFrames frames from step `begin` of the circle on, in turns.
  static std::vector<double> Walk(int begin) {
    std::vector<double> turns(kFrames);
    for (uint32_t i = 0; i < kFrames; ++i) {
      turns[i] = (begin + static_cast<int>(i)) / 144.0;
    }
    return turns;
  }

  // Tracks one frame for each pose, with ids from `first` on.
  std::vector<TrackedFrame> Track(Pipeline& pipeline, FrameId first,
                                  const std::vector<double>& turns) const {
    std::vector<TrackedFrame> tracked;
    for (uint32_t i = 0; i < turns.size(); ++i) {
      const FrameId id(first.value + i);
      const SyntheticView view = world_.Observe(id, RingWorld::CamFromWorld(turns[i]));
      tracked.push_back(pipeline.Track(view.frame).tracked);
    }
    return tracked;
  }

  // The largest distance between a camera of the trajectory and its true position, m.
  static double LargestError(const Trajectory& trajectory, std::span<const double> turns) {
    double largest = 0.0;
    for (size_t i = 0; i < trajectory.size(); ++i) {
      const Rigid3 truth = Inverse(RingWorld::CamFromWorld(turns[i]));
      largest =
          std::max(largest, (trajectory[i].world_from_cam.translation - truth.translation).norm());
    }
    return largest;
  }

  const RingWorld& world_ = SharedRing();
  SystemOptions options_;
};

// The second session begins at a place that the map lacks, and later goes beyond its end.
TEST_P(PipelineStartTest, ASecondSessionGoesOnWithTheMap) {
  constexpr uint32_t kLost = 2;
  Map first = FirstSession();
  const FrameId begin = first.NextFrame();
  const KeyframeId next_keyframe = first.keyframes().NextId();
  const std::string before = Dump(first);
  const auto pipeline = MakePipeline();
  pipeline->Begin({.map = first.Snapshot(), .session = {.name = "second", .first_frame = begin}});
  ASSERT_NE(pipeline->map(), nullptr) << "the map is there before the first frame";
  std::vector<double> turns = Walk(12);
  std::fill_n(turns.begin(), kLost, 0.5);
  const std::vector<TrackedFrame> frames = Track(*pipeline, begin, turns);
  pipeline->Finish();
  const Map& map = *pipeline->map();

  for (uint32_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(frames[i].state, i < kLost ? TrackingState::kLost : TrackingState::kTracked) << i;
  }
  const Trajectory trajectory = ComposeTrajectory(map, frames);
  ASSERT_EQ(trajectory.size(), kFrames - kLost);
  EXPECT_LT(LargestError(trajectory, std::span(turns).subspan(kLost)), 0.01);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  ASSERT_EQ(map.sessions().size(), 2u);
  EXPECT_EQ(map.sessions()[1], (Session{"second", begin}));
  const Trajectory of_second = KeyframeTrajectory(map, 2);
  ASSERT_GT(of_second.size(), 0u);
  EXPECT_EQ(KeyframeTrajectory(map, 1).size() + of_second.size(), map.keyframes().size());
  EXPECT_GE(of_second.front().timestamp, frames[kLost].timestamp);
  EXPECT_GT(map.keyframes().NextId(), next_keyframe);
  // The second session sees what the first one has mapped.
  const auto is_keyframe = [&](const TrackedFrame& frame) {
    return map.KeyframeOfFrame(frame.frame).has_value();
  };
  const auto keyframe = std::find_if(frames.begin(), frames.end(), is_keyframe);
  ASSERT_NE(keyframe, frames.end());
  const KeyframeId oldest = *map.KeyframeOfFrame(keyframe->frame);
  EXPECT_LT(map.keyframes().At(oldest).covisible.front().keyframe, next_keyframe);
  EXPECT_EQ(Dump(first), before) << "the map that it began with is not changed";
}

TEST_P(PipelineStartTest, WithoutRelocalisationARunStaysLostAndChangesNothing) {
  options_.mapping.final_bundle_adjustment = true;
  options_.tracking.relocalise_by_words = false;
  Map first = FirstSession();
  const auto pipeline = MakePipeline();
  pipeline->Begin(
      {.map = first.Snapshot(), .session = {.name = "second", .first_frame = first.NextFrame()}});
  for (const TrackedFrame& frame : Track(*pipeline, first.NextFrame(), Walk(0))) {
    EXPECT_EQ(frame.state, TrackingState::kLost);
    EXPECT_FALSE(frame.from_keyframe);
  }
  pipeline->Finish();
  EXPECT_EQ(Dump(*pipeline->map()), Dump(first));
  EXPECT_EQ(pipeline->map()->sessions().size(), 1u);
}

TEST_P(PipelineStartTest, LocalizationChangesNothingInTheMap) {
  options_.mapping.final_bundle_adjustment = true;
  Map first = FirstSession();
  const std::string before = Dump(first);
  const auto pipeline = MakePipeline();
  pipeline->Begin({.map = first.Snapshot(),
                   .session = {.name = "second", .first_frame = first.NextFrame()},
                   .localization_only = true});
  const std::vector<double> turns = Walk(0);
  const std::vector<TrackedFrame> frames = Track(*pipeline, first.NextFrame(), turns);
  pipeline->Finish();
  for (const TrackedFrame& frame : frames) {
    EXPECT_EQ(frame.state, TrackingState::kTracked);
  }
  const Trajectory trajectory = ComposeTrajectory(*pipeline->map(), frames);
  ASSERT_EQ(trajectory.size(), kFrames);
  EXPECT_LT(LargestError(trajectory, turns), 0.01);
  EXPECT_EQ(Dump(*pipeline->map()), before);
  EXPECT_EQ(pipeline->map()->sessions().size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(All, PipelineStartTest, testing::Bool(),
                         [](const auto& info) { return info.param ? "threaded" : "sequential"; });

}  // namespace
}  // namespace hullslam
