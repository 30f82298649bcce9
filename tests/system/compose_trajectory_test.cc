// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/compose_trajectory.h"

#include <gtest/gtest.h>

#include <vector>

#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

Rigid3 Shift(double x) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0)}; }

TEST(ComposeTrajectory, FramesFollowTheirKeyframes) {
  Map map;
  const KeyframeId keyframe = map.AddKeyframe(MakeFrame(4, 1), Shift(-1.0));
  std::vector<TrackedFrame> frames(3);
  frames[0].frame = FrameId(4);  // the keyframe itself: it has the keyframe's pose
  frames[1].frame = FrameId(5);
  frames[2].frame = FrameId(6);
  for (TrackedFrame& frame : frames) {
    frame.timestamp = frame.frame.value;
    frame.state = TrackingState::kTracked;
    frame.from_keyframe = RelativePose{keyframe, Shift(-0.5), 1.0};
  }
  frames[2].state = TrackingState::kLost;
  map.SetPose(keyframe, Shift(-3.0));
  const Trajectory trajectory = ComposeTrajectory(map, frames);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].timestamp, 4.0);
  EXPECT_EQ(trajectory[0].world_from_cam.translation.x(), 3.0);
  EXPECT_EQ(trajectory[1].timestamp, 5.0);
  EXPECT_EQ(trajectory[1].world_from_cam.translation.x(), 3.5);
}

// A culled keyframe is not adjusted any more, so a refined pose of its frame is better.
TEST(ComposeTrajectory, ARefinedPoseReplacesThatOfACulledKeyframe) {
  Map map;
  const KeyframeId root = map.AddKeyframe(MakeFrame(4, 1), Shift(-1.0));
  const KeyframeId keyframe = map.AddKeyframe(MakeFrame(7, 1), Shift(-2.0));
  SetParent(map, keyframe, root);
  map.CullKeyframe(keyframe);
  std::vector<TrackedFrame> frames(1);
  frames[0].frame = FrameId(7);
  frames[0].state = TrackingState::kTracked;
  frames[0].from_keyframe = RelativePose{root, Shift(-9.0), 1.0};  // when it was tracked
  EXPECT_EQ(ComposeTrajectory(map, frames)[0].world_from_cam.translation.x(), 2.0);
  frames[0].from_keyframe = RelativePose{keyframe, Shift(-0.25), 1.0};  // refined
  EXPECT_EQ(ComposeTrajectory(map, frames)[0].world_from_cam.translation.x(), 2.25);
}

// Between islands no relative pose is known.
TEST(ComposeTrajectory, HasTheFramesOfTheMainIslandOnly) {
  Map map;
  const IslandId other = map.BeginIsland();
  const IslandId main = map.BeginIsland();
  const KeyframeId first = map.AddKeyframe(MakeFrame(1, 1), Shift(-1.0), other);
  const KeyframeId second = map.AddKeyframe(MakeFrame(4, 1), Shift(-2.0), main);
  map.AddKeyframe(MakeFrame(7, 1), Shift(-3.0), main);
  std::vector<TrackedFrame> frames(4);
  for (uint32_t i = 0; i < 4; ++i) {
    frames[i].frame = FrameId(std::vector<uint32_t>{1, 2, 4, 5}[i]);
    frames[i].timestamp = frames[i].frame.value;
    frames[i].state = TrackingState::kTracked;
    frames[i].from_keyframe = RelativePose{i < 2 ? first : second, Shift(-0.5), 1.0};
  }
  const auto expect_main_only = [&] {
    const Trajectory trajectory = ComposeTrajectory(map, frames);
    ASSERT_EQ(trajectory.size(), 2u);
    EXPECT_EQ(trajectory[0].timestamp, 4.0);
    EXPECT_EQ(trajectory[1].world_from_cam.translation.x(), 2.5);
    EXPECT_EQ(KeyframeTrajectory(map).size(), 2u);
  };
  expect_main_only();
  KeepOnlyIsland(map, main);
  expect_main_only();
  LoseFramesElsewhere(map, frames);
  for (uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].state, i < 2 ? TrackingState::kLost : TrackingState::kTracked);
    EXPECT_EQ(frames[i].from_keyframe.has_value(), i >= 2);
  }
  // A frame whose keyframe was removed, but which was found in the main island at the end.
  frames[0].state = TrackingState::kTracked;
  frames[0].from_keyframe = RelativePose{second, Shift(-0.25), 1.0};
  EXPECT_EQ(ComposeTrajectory(map, frames).front().world_from_cam.translation.x(), 2.25);
}

TEST(ReplaceEarlyFrames, KeepsATrackedFrameWithClearlyMoreLandmarks) {
  std::vector<TrackedFrame> frames(4);
  std::vector<TrackedFrame> early(4);
  for (uint32_t i = 0; i < 4; ++i) {
    frames[i].frame = early[i].frame = FrameId(10 + i);
    frames[i].state = early[i].state = TrackingState::kTracked;
    frames[i].inliers = 600;
    early[i].inliers = i == 1 ? 590 : 259;
    early[i].from_keyframe = RelativePose{KeyframeId(0), Shift(1.0), 1.0};
  }
  frames[2].state = TrackingState::kLost;
  early.pop_back();  // this frame was not found
  ReplaceEarlyFrames(early, frames);
  EXPECT_FALSE(frames[0].from_keyframe);
  EXPECT_TRUE(frames[1].from_keyframe);
  EXPECT_TRUE(frames[2].from_keyframe);
  EXPECT_EQ(frames[2].state, TrackingState::kTracked);
  EXPECT_FALSE(frames[3].from_keyframe);
}

TEST(KeyframeTrajectory, HasThePosesOfTheKeyframesInTheOrderOfTheirFrames) {
  Map map;
  map.AddKeyframe(MakeFrame(7, 1), Shift(2.0));
  map.AddKeyframe(MakeFrame(4, 1), Shift(-1.0));  // its masks came late
  const Trajectory trajectory = KeyframeTrajectory(map);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].world_from_cam.translation.x(), 1.0);
  EXPECT_EQ(trajectory[1].world_from_cam.translation.x(), -2.0);
}

}  // namespace
}  // namespace hullslam
