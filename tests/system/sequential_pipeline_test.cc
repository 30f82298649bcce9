// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "hullslam/util/check.h"
#include "map/made_map.h"
#include "system/pipeline.h"
#include "system/pipeline_cases.h"
#include "system/ring_path.h"

namespace hullslam {
namespace {

struct Outcome {
  std::vector<TrackedFrame> frames;
  std::shared_ptr<const Map> map;
};

Outcome RunOnce(const SyntheticWorld& world, const SystemOptions& options = {}) {
  const auto pipeline = MakeSequentialPipeline(world.sensor(), options);
  Outcome run;
  run.frames = TrackPath(*pipeline, world, 0, 60);
  pipeline->Finish();
  run.map = pipeline->map();
  return run;
}

void ExpectSameBits(const Rigid3& a, const Rigid3& b) {
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
  EXPECT_EQ(a.translation, b.translation);
}

TEST(SequentialPipeline, TwoRunsGiveTheSameFramesToTheBit) {
  const SyntheticWorld world = NoisyWorld();
  const Outcome a = RunOnce(world);
  const Outcome b = RunOnce(world);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].state, b.frames[i].state);
    ASSERT_EQ(a.frames[i].from_keyframe.has_value(), b.frames[i].from_keyframe.has_value());
    EXPECT_EQ(a.frames[i].inliers, b.frames[i].inliers);
    if (a.frames[i].from_keyframe) {
      EXPECT_EQ(a.frames[i].from_keyframe->reference, b.frames[i].from_keyframe->reference);
      ExpectSameBits(a.frames[i].from_keyframe->cam_from_reference,
                     b.frames[i].from_keyframe->cam_from_reference);
    }
    ExpectSameBits(a.frames[i].cam_from_world, b.frames[i].cam_from_world);
  }
}

TEST(SequentialPipeline, TwoRunsGiveTheSameMapToTheBit) {
  const SyntheticWorld world = NoisyWorld();
  const Outcome a = RunOnce(world);
  const Outcome b = RunOnce(world);
  EXPECT_GT(a.map->keyframes().NextId().value, 5u);
  EXPECT_EQ(a.map->keyframes().size(), b.map->keyframes().size());
  EXPECT_EQ(a.map->landmarks().size(), b.map->landmarks().size());
  a.map->keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    const Keyframe& same = b.map->keyframes().At(id);
    ExpectSameBits(keyframe.cam_from_world, same.cam_from_world);
    EXPECT_EQ(keyframe.landmarks, same.landmarks);
    EXPECT_EQ(keyframe.parent, same.parent);
  });
  a.map->landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    const Landmark& same = b.map->landmarks().At(id);
    EXPECT_EQ(landmark.position, same.position);
    EXPECT_EQ(landmark.descriptor, same.descriptor);
    EXPECT_EQ(landmark.viewing_direction, same.viewing_direction);
    EXPECT_EQ(landmark.visible, same.visible);
    EXPECT_EQ(landmark.found, same.found);
  });
}

// All frames are relative to keyframes, and Finish has moved all keyframes but the root.
TEST(SequentialPipeline, FramesFollowTheKeyframesThatFinishAdjusts) {
  const SyntheticWorld world = NoisyWorld();
  SystemOptions options;
  options.mapping.local_keyframes = 2;
  options.mapping.fixed_keyframes = 1;
  options.mapping.final_bundle_adjustment = false;
  const Outcome before = RunOnce(world, options);
  options.mapping.final_bundle_adjustment = true;
  const Outcome after = RunOnce(world, options);
  const Trajectory a = ComposeTrajectory(*before.map, before.frames);
  const Trajectory b = ComposeTrajectory(*after.map, after.frames);
  ASSERT_EQ(a.size(), 60u);
  ASSERT_EQ(b.size(), 60u);
  size_t followed = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const TrackedFrame& frame = after.frames[i];
    const std::optional<KeyframeId> keyframe = after.map->KeyframeOfFrame(frame.frame);
    const KeyframeId own = keyframe ? *keyframe : frame.from_keyframe->reference;
    const double moved = (a[i].world_from_cam.translation - b[i].world_from_cam.translation).norm();
    if (after.map->NearestAlive(own) == KeyframeId(0)) {
      EXPECT_EQ(moved, 0.0) << i;
    } else {
      EXPECT_GT(moved, 1e-9) << i;
      ++followed;
    }
  }
  EXPECT_GT(followed, after.map->keyframes().size());
}

// Several seeds of the noise are used, because with a single one the error may also grow by a few
// percent.
TEST(SequentialPipeline, FinishMakesThePathBetterOnAverage) {
  SystemOptions options;
  options.mapping.local_keyframes = 2;
  options.mapping.fixed_keyframes = 1;
  double error_before = 0.0;
  double error_after = 0.0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    const SyntheticWorld world = NoisyWorld(seed);
    options.mapping.final_bundle_adjustment = false;
    const Outcome before = RunOnce(world, options);
    options.mapping.final_bundle_adjustment = true;
    const Outcome after = RunOnce(world, options);
    error_before += PathError(ComposeTrajectory(*before.map, before.frames), world.sensor());
    error_after += PathError(ComposeTrajectory(*after.map, after.frames), world.sensor());
  }
  EXPECT_LT(error_after, error_before);
}

TEST(SequentialPipeline, TwoRunsWithALoopGiveTheSameMapToTheBit) {
  const auto run = [] {
    RingPath path;
    const auto pipeline = MakeSequentialPipeline(path.sensor(), path.options());
    path.Track(*pipeline);
    pipeline->Finish();
    EXPECT_GE(RingPath::CountLoopEnds(*pipeline->map()), 2);
    return Dump(*pipeline->map());
  };
  EXPECT_EQ(run(), run());
}

// When Track returns, the loop is in the map and the whole map has been adjusted.
TEST(SequentialPipeline, TwoRunsWithAJoinOfIslandsGiveTheSameMapToTheBit) {
  RingPath path;
  path.BeMonocular();
  const auto run = [&] {
    const auto pipeline = MakeSequentialPipeline(path.sensor(), path.options());
    path.Track(*pipeline, 0, 22);
    path.TrackBlank(*pipeline, 22, 60);
    path.Track(*pipeline, 60, RingPath::kFrames);
    pipeline->Finish();
    EXPECT_EQ(pipeline->map()->islands_joined(), 1u);
    return Dump(*pipeline->map());
  };
  const std::string first = run();
  EXPECT_TRUE(run() == first);
}

TEST(SequentialPipeline, ClosesLoopsBeforeTrackReturns) {
  RingPath path;
  for (const bool is_adjusted : {false, true}) {
    path.options().loop.global_adjustment = is_adjusted;
    const auto pipeline = MakeSequentialPipeline(path.sensor(), path.options());
    const uint32_t end = path.TrackToLoop(*pipeline);
    EXPECT_GT(end, RingPath::kFramesPerTurn * 5 / 6);
    EXPECT_LT(end, RingPath::kFrames);
    EXPECT_EQ(pipeline->map()->correction_count(), is_adjusted ? 2u : 1u);
    EXPECT_EQ(pipeline->times().samples().contains("loop_adjustment"), is_adjusted);
  }
}

TEST(SequentialPipeline, AKeyframeIsInTheMapWhenTrackReturns) {
  const SyntheticWorld world = NoisyWorld();
  const SystemOptions options;
  const auto pipeline = MakeSequentialPipeline(world.sensor(), options);
  pipeline->Track(world.Observe(0).frame);
  const auto map = pipeline->map();
  EXPECT_EQ(map->KeyframeOfFrame(FrameId(0)), KeyframeId(0));
  EXPECT_GT(map->landmarks().size(), 100u);
}

TEST(SequentialPipeline, AnExceptionInMappingIsThrownByTheSameCall) {
  const FailingMapping failing;
  const SystemOptions options;
  const auto pipeline = MakeSequentialPipeline(failing.sensor, options);
  pipeline->Track(failing.first);
  EXPECT_THROW(pipeline->Track(failing.second), CheckError);
}

}  // namespace
}  // namespace hullslam
