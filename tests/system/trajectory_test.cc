// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/trajectory.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(Trajectory, APoseIsAtTheOriginUntilItIsGiven) {
  const StampedPose pose;
  EXPECT_EQ(pose.timestamp, 0.0);
  EXPECT_EQ(pose.world_from_cam * Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(Trajectory, PosesTakePointsOfTheCameraToTheWorld) {
  const Trajectory trajectory = {
      {2.5, Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 7.0))}};
  EXPECT_EQ(trajectory[0].world_from_cam * Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, 7));
}

}  // namespace
}  // namespace hullslam
