// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/trajectory.h"

#include <gtest/gtest.h>

#include <vector>

namespace hullslam {
namespace {

TEST(Trajectory, DefaultPoseIsTheIdentity) {
  const StampedPose pose;
  EXPECT_EQ(pose.timestamp, 0.0);
  EXPECT_EQ(pose.world_from_cam * Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(Trajectory, PosesMapPointsFromTheCameraToTheWorld) {
  const Trajectory trajectory = {
      {2.5, Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 7.0))}};
  EXPECT_EQ(trajectory[0].world_from_cam * Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, 7));
}

TEST(InterpolatePose, LiesBetweenNeighboursInTime) {
  const Eigen::Vector3d turn(0.0, 0.0, 0.4);
  const Trajectory trajectory = {{1.0, Rigid3()},
                                 {2.0, {ExpSo3(turn), Eigen::Vector3d(2.0, 0.0, 4.0)}}};
  const Rigid3 pose = InterpolatePose(trajectory, 1.25, 1.5).value();
  EXPECT_LT((pose.translation - Eigen::Vector3d(0.5, 0.0, 1.0)).norm(), 1e-12);
  EXPECT_LT((LogSo3(pose.rotation) - 0.25 * turn).norm(), 1e-12);
  EXPECT_EQ(InterpolatePose(trajectory, 2.0, 1.5)->translation.x(), 2.0);
  EXPECT_EQ(InterpolatePose(trajectory, 1.0, 1.5)->translation.x(), 0.0);
}

TEST(InterpolatePose, IsNothingOutsideTheTrajectoryAndInGaps) {
  const Trajectory trajectory = {{1.0, Rigid3()}, {2.0, Rigid3()}};
  EXPECT_FALSE(InterpolatePose(trajectory, 0.9, 1.5));
  EXPECT_FALSE(InterpolatePose(trajectory, 2.1, 1.5));
  EXPECT_FALSE(InterpolatePose(trajectory, 1.5, 0.5));
  EXPECT_FALSE(InterpolatePose({}, 1.0, 0.5));
}

// A file holds "0.300000" where a program computes 3 * 0.1, which is a little more.
TEST(InterpolatePose, TakesThePoseOfAStampThatIsRoundedInAnotherWay) {
  Trajectory trajectory;
  for (int i = 0; i < 4; ++i) {
    trajectory.push_back({0.1 * i, Rigid3(Eigen::Quaterniond::Identity(), {1.0 * i, 0.0, 0.0})});
  }
  for (const double stamp : {0.3, 0.3 - 9e-7, 0.3 + 9e-7}) {
    const std::optional<Rigid3> pose = InterpolatePose(trajectory, stamp, 0.01);
    ASSERT_TRUE(pose) << stamp;
    EXPECT_EQ(pose->translation.x(), 3.0);
  }
}

TEST(StampsOf, AreThoseOfThePoses) {
  EXPECT_EQ(StampsOf({{1.5, {}}, {2.5, {}}}), (std::vector<double>{1.5, 2.5}));
}

}  // namespace
}  // namespace hullslam
