// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hullslam/map_files/map_file.h"
#include "hullslam/util/check.h"
#include "map/islands.h"
#include "map/made_map.h"
#include "map_files/invariants.h"
#include "support/ring_world.h"
#include "support/temporary_folder.h"
#include "system/compose_trajectory.h"
#include "system/pipeline_cases.h"
#include "system/ring_path.h"

namespace hullslam {
namespace {

struct Kind {
  std::string name;
  std::unique_ptr<Pipeline> (*make)(const Sensor&, const SystemOptions&);

  // For the name of the test, which would have addresses in it.
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

std::unique_ptr<Pipeline> MakePatient(const Sensor& sensor, const SystemOptions& options) {
  return MakeThreadedPipeline(sensor, options, Pace::kWaitForMapper);
}

std::unique_ptr<Pipeline> MakeRealtime(const Sensor& sensor, const SystemOptions& options) {
  return MakeThreadedPipeline(sensor, options, Pace::kNeverWait);
}

// The guarantees of every pipeline.
class PipelineTest : public testing::TestWithParam<Kind> {
 protected:
  std::unique_ptr<Pipeline> Make() const { return GetParam().make(world_.sensor(), options_); }

  const SyntheticWorld world_ = NoisyWorld();
  SystemOptions options_ = {};
};

TEST_P(PipelineTest, HasNoMapBeforeTheFirstKeyframe) {
  const auto pipeline = Make();
  EXPECT_EQ(pipeline->map(), nullptr);
  const SyntheticWorld without_depth({.depth_share = 0.0});
  EXPECT_EQ(pipeline->Track(without_depth.Observe(0).frame).tracked.state,
            TrackingState::kNotInitialized);
  EXPECT_EQ(pipeline->map(), nullptr);
  EXPECT_EQ(pipeline->Track(world_.Observe(1).frame).tracked.state, TrackingState::kTracked);
  ASSERT_NE(pipeline->map(), nullptr);
  EXPECT_EQ(pipeline->map()->keyframes().size(), 1u);
}

TEST_P(PipelineTest, TracksEveryFrameWithASmallError) {
  const auto pipeline = Make();
  const std::vector<TrackedFrame> frames = TrackPath(*pipeline, world_, 0, 100);
  pipeline->Finish();
  for (const TrackedFrame& frame : frames) {
    EXPECT_EQ(frame.state, TrackingState::kTracked) << frame.frame.value;
  }
  const auto map = pipeline->map();
  EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
  EXPECT_GT(map->keyframes().NextId().value, 10u) << "more than ten were made, some may be culled";
  const Trajectory trajectory = ComposeTrajectory(*map, frames);
  EXPECT_EQ(trajectory.size(), 100u);
  EXPECT_LT(PathError(trajectory, world_.sensor()), 0.02);
}

TEST_P(PipelineTest, RecoversAfterFramesOfAnotherWorld) {
  const auto pipeline = Make();
  TrackPath(*pipeline, world_, 0, 10);
  const SyntheticWorld other({.points = 500, .seed = 2});
  for (const TrackedFrame& frame : TrackPath(*pipeline, other, 10, 13)) {
    EXPECT_EQ(frame.state, TrackingState::kLost);
  }
  for (const TrackedFrame& frame : TrackPath(*pipeline, world_, 13, 20)) {
    EXPECT_EQ(frame.state, TrackingState::kTracked);
  }
}

TEST_P(PipelineTest, FinishingTwiceIsLikeFinishingOnce) {
  const auto pipeline = Make();
  TrackPath(*pipeline, world_, 0, 30);
  pipeline->Finish();
  const auto map = pipeline->map();
  pipeline->Finish();
  EXPECT_EQ(pipeline->map(), map);
}

TEST_P(PipelineTest, FinishAdjustsTheWholeMapOnceIfTheOptionIsSet) {
  options_.mapping.final_bundle_adjustment = true;
  options_.mapping.local_keyframes = 2;
  options_.mapping.fixed_keyframes = 1;
  const auto pipeline = Make();
  const std::vector<TrackedFrame> frames = TrackPath(*pipeline, world_, 0, 60);
  pipeline->Finish();
  const auto map = pipeline->map();
  EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
  EXPECT_EQ(pipeline->times().samples().at("global_bundle_adjustment").size(), 1u);
  const Trajectory trajectory = ComposeTrajectory(*map, frames);
  ASSERT_EQ(trajectory.size(), frames.size());
  EXPECT_LT(PathError(trajectory, world_.sensor()), 0.01);
  pipeline->Finish();
  EXPECT_EQ(pipeline->map(), map);
}

TEST_P(PipelineTest, ACancelledFinishDoesNotAdjust) {
  options_.mapping.final_bundle_adjustment = true;
  const auto pipeline = Make();
  TrackPath(*pipeline, world_, 0, 30);
  Cancellation cancellation;
  cancellation.Request();
  pipeline->Finish(&cancellation, {});
  EXPECT_FALSE(pipeline->times().samples().contains("global_bundle_adjustment"));
  EXPECT_EQ(FindViolations(*pipeline->map()), std::vector<std::string>());
}

TEST_P(PipelineTest, FinishMayBeCancelledWhileItRuns) {
  options_.mapping.final_bundle_adjustment = true;
  const auto pipeline = Make();
  const std::vector<TrackedFrame> frames = TrackPath(*pipeline, world_, 0, 60);
  Cancellation cancellation;
  std::thread other([&] { cancellation.Request(); });
  pipeline->Finish(&cancellation, {});
  other.join();
  EXPECT_EQ(FindViolations(*pipeline->map()), std::vector<std::string>());
  EXPECT_LT(PathError(ComposeTrajectory(*pipeline->map(), frames), world_.sensor()), 0.02);
}

TEST_P(PipelineTest, TrackAfterFinishIsRefused) {
  const auto pipeline = Make();
  TrackPath(*pipeline, world_, 0, 2);
  pipeline->Finish();
  EXPECT_THROW(TrackPath(*pipeline, world_, 2, 3), CheckError);
}

TEST_P(PipelineTest, FinishWithoutAFrameIsAllowed) {
  const auto pipeline = Make();
  EXPECT_NO_THROW(pipeline->Finish());
  EXPECT_EQ(pipeline->map(), nullptr);
  EXPECT_TRUE(pipeline->times().samples().empty());
}

TEST_P(PipelineTest, MayBeDestroyedAtAnyTime) {
  for (const uint32_t frames : {0u, 1u, 2u, 25u}) {
    const auto pipeline = Make();
    EXPECT_EQ(TrackPath(*pipeline, world_, 0, frames).size(), frames);
  }
}

TEST_P(PipelineTest, MapsOutliveThePipeline) {
  std::shared_ptr<const Map> map;
  {
    const auto pipeline = Make();
    TrackPath(*pipeline, world_, 0, 25);
    map = pipeline->map();
  }
  EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
}

TEST_P(PipelineTest, AnExceptionInMappingReachesTheCaller) {
  const FailingMapping failing;
  const auto pipeline = GetParam().make(failing.sensor, options_);
  EXPECT_EQ(pipeline->Track(failing.first).tracked.state, TrackingState::kTracked);
  EXPECT_THROW(
      {
        pipeline->Track(failing.second);
        pipeline->Finish();
      },
      CheckError);
}

TEST_P(PipelineTest, AfterAnExceptionInMappingTheRunIsOverAndItsMapUsable) {
  const FailingMapping failing;
  const auto pipeline = GetParam().make(failing.sensor, options_);
  std::vector<TrackedFrame> frames = {pipeline->Track(failing.first).tracked};
  EXPECT_THROW(
      {
        frames.push_back(pipeline->Track(failing.second).tracked);
        pipeline->Finish();
      },
      CheckError);
  const auto map = pipeline->map();
  EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
  EXPECT_EQ(ComposeTrajectory(*map, frames).size(), frames.size());
  auto third = std::make_shared<Frame>(*failing.second);
  third->id = FrameId(2);
  EXPECT_THROW(pipeline->Track(third), CheckError);
  EXPECT_THROW(pipeline->Finish(), CheckError);
  EXPECT_THROW(pipeline->Finish(), CheckError);
  EXPECT_EQ(pipeline->map(), map) << "a half-edited map must not be published";
}

TEST_P(PipelineTest, AnExceptionThatIsNeverRethrownDoesNoHarm) {
  const FailingMapping failing;
  const auto pipeline = GetParam().make(failing.sensor, options_);
  pipeline->Track(failing.first);
  try {
    pipeline->Track(failing.second);
  } catch (const CheckError&) {  // the sequential pipeline throws immediately
  }
}

TEST_P(PipelineTest, TimesHaveOneEntryPerCall) {
  const auto pipeline = Make();
  TrackPath(*pipeline, world_, 0, 30);
  pipeline->Finish();
  const StageTimes times = pipeline->times();
  EXPECT_EQ(times.samples().at("pose").size(), 30u);
  EXPECT_EQ(times.samples().at("map_insert").size(), pipeline->map()->keyframes().NextId().value);
}

// The pipelines that leave out no keyframe.
class LoopPipelineTest : public testing::TestWithParam<Kind> {
 protected:
  std::unique_ptr<Pipeline> Make() { return GetParam().make(path_.sensor(), path_.options()); }

  RingPath path_;
};

TEST_P(LoopPipelineTest, APathThatReturnsIsClosed) {
  path_.options().loop.enabled = false;
  const auto open = Make();
  const std::vector<TrackedFrame> drifted = path_.Track(*open);
  open->Finish();
  EXPECT_EQ(RingPath::CountLoopEnds(*open->map()), 0);
  const double drift = RingPath::ClosureError(*open->map(), drifted);
  EXPECT_GT(drift, 0.02);
  EXPECT_FALSE(open->times().samples().contains("loop_detection"));

  path_.options().loop.enabled = true;
  const auto closed = Make();
  const std::vector<TrackedFrame> frames = path_.Track(*closed);
  closed->Finish();
  EXPECT_EQ(FindViolations(*closed->map()), std::vector<std::string>());
  EXPECT_GE(RingPath::CountLoopEnds(*closed->map()), 2);
  EXPECT_LT(RingPath::ClosureError(*closed->map(), frames), 0.1 * drift);
  EXPECT_TRUE(closed->times().samples().contains("loop_detection"));
}

TEST_P(LoopPipelineTest, MayBeDestroyedWhileALoopIsClosed) {
  const auto pipeline = Make();
  path_.Track(*pipeline, 0, 170);
  EXPECT_EQ(FindViolations(*pipeline->map()), std::vector<std::string>());
}

// A camera that goes on at another place after it was lost, and later sees the first place again.
void ExpectIslandsJoined(const RingPath& path, Pipeline& pipeline) {
  std::vector<TrackedFrame> frames = path.Track(pipeline, 0, 22);
  for (const auto& more :
       {path.TrackBlank(pipeline, 22, 60), path.Track(pipeline, 60, RingPath::kFrames)}) {
    frames.insert(frames.end(), more.begin(), more.end());
  }
  pipeline.Finish();
  const std::shared_ptr<const Map> map = pipeline.map();
  EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
  EXPECT_EQ(map->islands_begun(), 2u);
  EXPECT_EQ(map->islands_joined(), 1u);
  EXPECT_EQ(Islands(*map).size(), 1u);
  for (const TrackedFrame& early : pipeline.TakeEarlyFrames()) {
    frames.at(early.frame.value) = early;
  }
  const Trajectory trajectory = ComposeTrajectory(*map, frames);
  EXPECT_EQ(trajectory.size(), RingPath::kFrames - 38u) << "all frames but the blank ones";
  EXPECT_LT(RingPath::AlignedError(trajectory), 0.03);
}

TEST_P(LoopPipelineTest, IslandsOfALostMonocularCameraAreJoined) {
  path_.BeMonocular();
  ExpectIslandsJoined(path_, *Make());
}

TEST_P(LoopPipelineTest, IslandsOfALostCameraWithDepthAreJoined) {
  path_.BeExact();
  ExpectIslandsJoined(path_, *Make());
}

// The second part never sees the first place again.
TEST_P(LoopPipelineTest, IfIslandsAreNotJoinedTheLargestStays) {
  path_.BeMonocular();
  const auto pipeline = Make();
  std::vector<TrackedFrame> frames = path_.Track(*pipeline, 0, 22);
  for (const auto& more : {path_.TrackBlank(*pipeline, 22, 60), path_.Track(*pipeline, 60, 110)}) {
    frames.insert(frames.end(), more.begin(), more.end());
  }
  pipeline->Finish();
  const std::shared_ptr<const Map> map = pipeline->map();
  EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
  EXPECT_EQ(map->islands_joined(), 0u);
  EXPECT_EQ(Islands(*map), std::vector<IslandId>{IslandId(1)});
  const Trajectory trajectory = ComposeTrajectory(*map, frames);
  ASSERT_FALSE(trajectory.empty());
  EXPECT_GE(trajectory.front().timestamp, 60 / path_.sensor().frames_per_second);
  EXPECT_LT(RingPath::AlignedError(trajectory), 0.03);
  // The smaller one is a map of its own.
  ASSERT_EQ(pipeline->left_islands().size(), 1u);
  const Map& left = *pipeline->left_islands().front();
  EXPECT_EQ(FindViolations(left), std::vector<std::string>());
  EXPECT_EQ(Islands(left), std::vector<IslandId>{IslandId(0)});
  const Trajectory first = ComposeTrajectory(left, frames);
  ASSERT_GE(first.size(), 5u);
  EXPECT_LT(first.back().timestamp, 22 / path_.sensor().frames_per_second);
  EXPECT_LT(RingPath::AlignedError(first), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Loops, LoopPipelineTest,
                         testing::Values(Kind{"sequential", MakeSequentialPipeline},
                                         Kind{"threaded", MakePatient}),
                         [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(All, PipelineTest,
                         testing::Values(Kind{"sequential", MakeSequentialPipeline},
                                         Kind{"threaded", MakePatient},
                                         Kind{"realtime", MakeRealtime}),
                         [](const auto& info) { return info.param.name; });

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
  // About 8 mm; which frames have become keyframes depends on the threads, and so does the error.
  EXPECT_LT(LargestError(trajectory, std::span(turns).subspan(kLost)), 0.015);
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
