// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/compose_trajectory.h"

#include <gtest/gtest.h>

#include <vector>

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
    frame.pose = RelativePose{keyframe, Shift(-0.5), 1.0};
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

TEST(KeyframeTrajectory, HasThePosesOfTheKeyframes) {
  Map map;
  map.AddKeyframe(MakeFrame(4, 1), Shift(-1.0));
  map.AddKeyframe(MakeFrame(7, 1), Shift(2.0));
  const Trajectory trajectory = KeyframeTrajectory(map);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].world_from_cam.translation.x(), 1.0);
  EXPECT_EQ(trajectory[1].world_from_cam.translation.x(), -2.0);
}

}  // namespace
}  // namespace hullslam
