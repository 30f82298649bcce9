// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/pipeline_start.h"

#include <gtest/gtest.h>

#include <utility>

#include "hullslam/map_files/map_file.h"
#include "map/invariants.h"
#include "map/made_map.h"
#include "support/temporary_folder.h"
#include "system/pipeline_cases.h"
#include "system/sequential_pipeline.h"
#include "system/threaded_pipeline.h"

namespace hullslam {
namespace {

constexpr uint32_t kFrames = 25;  // of a session

class PipelineStartTest : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<Pipeline> MakePipeline() const {
    return GetParam() ? MakeThreadedPipeline(world_.sensor(), options_, Pace::kWaitForMapper)
                      : MakeSequentialPipeline(world_.sensor(), options_);
  }

  // The map of a first session along the path.
  Map FirstSession() const {
    const TemporaryFolder folder;
    const auto pipeline = MakeSequentialPipeline(world_.sensor(), options_);
    pipeline->Begin({.session = {.name = "first", .first_frame = FrameId(0)}});
    TrackPath(*pipeline, world_, 0, kFrames);
    pipeline->Finish();
    WriteMap(folder.path() / "map", *pipeline->map(), {.camera = world_.sensor().camera});
    return ReadMap(folder.path() / "map").map;
  }

  // The frames of the path again, at the same times, with ids from that of `first` on.
  std::vector<TrackedFrame> TrackAgain(Pipeline& pipeline, FrameId first) const {
    std::vector<TrackedFrame> tracked;
    for (uint32_t i = 0; i < kFrames; ++i) {
      auto frame = std::make_shared<Frame>(*PathFrame(world_, i));
      frame->id = FrameId(first.value + i);
      tracked.push_back(pipeline.Track(std::move(frame)).tracked);
    }
    return tracked;
  }

  const SyntheticWorld world_ = NoisyWorld();
  SystemOptions options_;
};

// Finds the frame by keyframe 0, but not before it was asked `failures` times.
Relocalise ByKeyframe0(int failures) {
  return [failures](const Frame& frame, const Map& map,
                    const TrackingContext& context) mutable -> std::optional<PoseEstimate> {
    if (failures-- > 0) {
      return std::nullopt;
    }
    LastFrame last;
    last.reference = KeyframeId(0);
    last.frame = map.keyframes().At(KeyframeId(0)).frame;
    last.cam_from_world = map.keyframes().At(KeyframeId(0)).cam_from_world;
    return PoseByReferenceKeyframe(frame, map, context, last);
  };
}

TEST_P(PipelineStartTest, ASecondSessionGoesOnWithTheMap) {
  Map first = FirstSession();
  const FrameId begin = first.NextFrame();
  const KeyframeId next_keyframe = first.keyframes().NextId();
  const std::string before = Dump(first);
  const auto pipeline = MakePipeline();
  pipeline->Begin({.map = first.Snapshot(),
                   .session = {.name = "second", .first_frame = begin},
                   .relocalise = ByKeyframe0(2)});
  ASSERT_NE(pipeline->map(), nullptr) << "the map is there before the first frame";
  const std::vector<TrackedFrame> frames = TrackAgain(*pipeline, begin);
  pipeline->Finish();
  const Map& map = *pipeline->map();

  for (uint32_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(frames[i].state, i < 2 ? TrackingState::kLost : TrackingState::kTracked) << i;
  }
  const Trajectory trajectory = ComposeTrajectory(map, frames);
  ASSERT_EQ(trajectory.size(), kFrames - 2);
  EXPECT_LT(PathError(trajectory, world_.sensor()), 0.01);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  ASSERT_EQ(map.sessions().size(), 2u);
  EXPECT_EQ(map.sessions()[1], (Session{"second", begin}));
  const Trajectory of_second = KeyframeTrajectory(map, 2);
  ASSERT_GT(of_second.size(), 0u);
  EXPECT_EQ(KeyframeTrajectory(map, 1).size() + of_second.size(), map.keyframes().size());
  EXPECT_GE(of_second.front().timestamp, frames[2].timestamp);
  EXPECT_GT(map.keyframes().NextId(), next_keyframe);
  // The second session sees what the first one has mapped.
  const Keyframe& newest = map.keyframes().At(KeyframeId(map.keyframes().NextId().value - 1));
  EXPECT_GE(newest.frame->id, begin);
  EXPECT_LT(newest.covisible.front().keyframe, next_keyframe);
  EXPECT_EQ(Dump(first), before) << "the map that it began with is not changed";
}

TEST_P(PipelineStartTest, WithoutASourceARunStaysLostAndChangesNothing) {
  options_.mapping.final_bundle_adjustment = true;
  Map first = FirstSession();
  const auto pipeline = MakePipeline();
  pipeline->Begin(
      {.map = first.Snapshot(), .session = {.name = "second", .first_frame = first.NextFrame()}});
  for (const TrackedFrame& frame : TrackAgain(*pipeline, first.NextFrame())) {
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
                   .localization_only = true,
                   .relocalise = ByKeyframe0(0)});
  const std::vector<TrackedFrame> frames = TrackAgain(*pipeline, first.NextFrame());
  pipeline->Finish();
  for (const TrackedFrame& frame : frames) {
    EXPECT_EQ(frame.state, TrackingState::kTracked);
  }
  const Trajectory trajectory = ComposeTrajectory(*pipeline->map(), frames);
  ASSERT_EQ(trajectory.size(), kFrames);
  EXPECT_LT(PathError(trajectory, world_.sensor()), 0.01);
  EXPECT_EQ(Dump(*pipeline->map()), before);
  EXPECT_EQ(pipeline->map()->sessions().size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(All, PipelineStartTest, testing::Bool(),
                         [](const auto& info) { return info.param ? "threaded" : "sequential"; });

}  // namespace
}  // namespace hullslam
