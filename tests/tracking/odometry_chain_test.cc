// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/odometry_chain.h"

#include <gtest/gtest.h>

#include <optional>

namespace hullslam {
namespace {

Rigid3 Sideways(double x) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0)}; }

// A camera that moves by 0.1 to the right in each frame of 0.1 s.
class OdometryChainTest : public testing::Test {
 protected:
  // The next frame: tracked with the camera at `x` in the map, by a motion from the last frame if
  // that `is_measured`. A motion of 0.1 in the odometry is one of `scale` times 0.1 in the map.
  Odometry Track(double x, bool is_measured = true, double scale = 1.0, uint32_t corrections = 0) {
    TrackedFrame frame = Next(TrackingState::kTracked);
    frame.cam_from_world = Sideways(-x);
    LastFrame last;
    last.map_per_odometry = scale;
    if (is_measured) {
      last.motion = CameraMotion{Sideways(-0.1 * scale), 0.1};
    }
    return *chain_.Add(frame, last, {}, corrections);
  }
  std::optional<Odometry> Lose(const std::optional<MotionPrior>& prior = {}) {
    return chain_.Add(Next(TrackingState::kLost), LastFrame(), prior, 0);
  }
  TrackedFrame Next(TrackingState state) {
    TrackedFrame frame;
    frame.frame = FrameId(number_);
    frame.timestamp = 0.1 * number_++;
    frame.state = state;
    return frame;
  }

  OdometryChain chain_;
  uint32_t number_ = 0;
};

TEST_F(OdometryChainTest, BeginsInTheWorldOfTheMap) {
  EXPECT_FALSE(Lose().has_value());
  const Odometry begun = Track(5.0, false);
  EXPECT_EQ(begun.step, OdometryStep::kBegun);
  EXPECT_EQ(begun.odom_from_cam.translation.x(), 5.0);
  EXPECT_EQ(begun.map_from_odom.translation.norm(), 0.0);
  EXPECT_EQ(begun.corrected_at, FrameId(1));
  const Odometry next = Track(5.1);
  EXPECT_EQ(next.step, OdometryStep::kMeasured);
  EXPECT_NEAR(next.odom_from_cam.translation.x(), 5.1, 1e-12);
  EXPECT_NEAR(next.map_from_odom.translation.norm(), 0.0, 1e-12);
  EXPECT_NEAR(next.linear_velocity.x(), 1.0, 1e-9);
  EXPECT_EQ(next.corrected_at, FrameId(1));
}

// The map jumps by 3, and its unit of length doubles; the odometry goes on by 0.1 per frame.
TEST_F(OdometryChainTest, CorrectionsOfTheMapDoNotMoveIt) {
  Track(0.0, false);
  Track(0.1);
  const Odometry jumped = Track(3.2, true, 1.0, 1);
  EXPECT_NEAR(jumped.odom_from_cam.translation.x(), 0.2, 1e-12);
  EXPECT_NEAR(jumped.map_from_odom.translation.x(), 3.0, 1e-12);
  EXPECT_EQ(jumped.corrected_at, FrameId(2));
  const Odometry rescaled = Track(6.6, true, 2.0, 2);
  EXPECT_NEAR(rescaled.odom_from_cam.translation.x(), 0.3, 1e-12);
  EXPECT_NEAR(rescaled.linear_velocity.x(), 1.0, 1e-9);
  EXPECT_NEAR((rescaled.map_from_odom * rescaled.odom_from_cam).translation.x(), 6.6, 1e-12);
  EXPECT_EQ(rescaled.corrected_at, FrameId(3));
  EXPECT_EQ(Track(6.8, true, 2.0, 2).corrected_at, FrameId(3));
}

// Four steps with the last velocity, then none; a relocalised frame does not move it.
TEST_F(OdometryChainTest, GoesOnOverLostFrames) {
  Track(0.0, false);
  Track(0.1);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(Lose()->step, OdometryStep::kPredicted) << i;
  }
  const Odometry stopped = *Lose();
  EXPECT_EQ(stopped.step, OdometryStep::kStopped);
  EXPECT_NEAR(stopped.odom_from_cam.translation.x(), 0.5, 1e-9);
  EXPECT_EQ(stopped.linear_velocity.norm(), 0.0);
  EXPECT_EQ(stopped.corrected_at, FrameId(0));
  const Odometry found = Track(0.9, false);
  EXPECT_NEAR(found.odom_from_cam.translation.x(), 0.5, 1e-9);
  EXPECT_NEAR(found.map_from_odom.translation.x(), 0.4, 1e-9);
  EXPECT_EQ(found.corrected_at, FrameId(7));
}

TEST_F(OdometryChainTest, TakesThePriorWhereNothingIsMeasured) {
  Track(0.0, false);
  Track(0.1);
  const Odometry odometry = *Lose(MotionPrior{Sideways(-0.3), 0.1});
  EXPECT_EQ(odometry.step, OdometryStep::kPrior);
  EXPECT_NEAR(odometry.odom_from_cam.translation.x(), 0.4, 1e-12);
}

}  // namespace
}  // namespace hullslam
