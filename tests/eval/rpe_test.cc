// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/rpe.h"

#include <gtest/gtest.h>

#include <numbers>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Ten poses per second, straight ahead at `speed` m/s, turning about z at `turn` rad/s.
Trajectory Drive(int count, double speed, double turn = 0.0) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back({t, Rigid3(ExpSo3({0.0, 0.0, turn * t}), {speed * t, 0.0, 0.0})});
  }
  return trajectory;
}

TEST(Rpe, MeasuresDriftInTranslation) {
  const RpeResult report = EvaluateRpe(Drive(31, 1.0), Drive(31, 1.1));
  ASSERT_TRUE(report.ok()) << report.failure;
  EXPECT_EQ(report.motions, 21U);
  EXPECT_NEAR(report.translation.rmse, 0.1, 1e-9);
  EXPECT_NEAR(report.translation.max, 0.1, 1e-9);
  EXPECT_NEAR(report.rotation.max, 0.0, 1e-6);
}

TEST(Rpe, MeasuresDriftInRotationInDegrees) {
  const double turn = std::numbers::pi / 180.0;
  const RpeResult report = EvaluateRpe(Drive(31, 0.0), Drive(31, 0.0, turn));
  EXPECT_NEAR(report.rotation.rmse, 1.0, 1e-6);
  EXPECT_NEAR(report.translation.rmse, 0.0, 1e-12);
}

// Files of EuRoC, COLMAP and others have qw first. Without a header nothing else tells them apart
// from files of TUM.
TEST(Rpe, RotationsWithTheirRealPartFirstAreNoticed) {
  const Trajectory estimate = Drive(31, 1.0, 0.5);
  const Trajectory turned_otherwise = Drive(31, 1.0, -0.5);
  Trajectory swapped = estimate;
  for (StampedPose& pose : swapped) {
    const Eigen::Quaterniond q = pose.world_from_cam.rotation;
    pose.world_from_cam.rotation = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y());
  }
  const auto described = [&](const Trajectory& reference) {
    return DescribeSwappedRotations(reference, estimate, EvaluateRpe(reference, estimate));
  };
  EXPECT_NE(described(swapped).find("qw first"), std::string::npos);
  EXPECT_EQ(described(estimate), "");
  EXPECT_EQ(described(turned_otherwise), "");
}

TEST(Rpe, IsInvariantUnderTheChoiceOfWorldFrames) {
  const Trajectory reference = Drive(31, 1.0, 0.5);
  Trajectory estimate = Drive(31, 1.2, 0.4);
  const RpeResult before = EvaluateRpe(reference, estimate);
  const Rigid3 motion(ExpSo3({1.0, 2.0, 3.0}), {10.0, -20.0, 5.0});
  for (StampedPose& pose : estimate) {
    pose.world_from_cam = motion * pose.world_from_cam;
  }
  const RpeResult after = EvaluateRpe(reference, estimate);
  EXPECT_GT(before.translation.rmse, 0.1);
  EXPECT_NEAR(before.translation.rmse, after.translation.rmse, 1e-9);
  EXPECT_NEAR(before.rotation.rmse, after.rotation.rmse, 1e-6);
}

TEST(Rpe, WithADeltaInFramesComparesNeighbours) {
  const RpeResult report = EvaluateRpe(Drive(31, 1.0), Drive(31, 2.0),
                                       {.unit = RpeOptions::Unit::kFrames, .delta = 1.0});
  EXPECT_EQ(report.motions, 30U);
  EXPECT_NEAR(report.translation.mean, 0.1, 1e-9);
}

TEST(Rpe, ScalesTheEstimate) {
  const RpeResult report = EvaluateRpe(Drive(31, 1.0), Drive(31, 0.5), {.scale = 2.0});
  EXPECT_NEAR(report.translation.max, 0.0, 1e-9);
}

TEST(Rpe, MotionsAcrossAGapAreLeftOut) {
  Trajectory estimate = Drive(31, 1.0);
  estimate.erase(estimate.begin() + 8, estimate.begin() + 23);  // 0.8 s to 2.2 s are missing
  const RpeResult report = EvaluateRpe(Drive(31, 1.0), estimate);
  EXPECT_FALSE(report.ok());
  EXPECT_EQ(report.motions, 0U);
}

TEST(Rpe, OptionsAreChecked) {
  EXPECT_THROW(EvaluateRpe({}, {}, {.delta = 0.0}), CheckError);
  EXPECT_THROW(EvaluateRpe({}, {}, {.unit = RpeOptions::Unit::kFrames, .delta = 0.5}), CheckError);
  EXPECT_FALSE(EvaluateRpe({}, {}).ok());
}

// Motions of 1 s, where the pose at the end is late. A tenth of the motion is the limit.
TEST(Rpe, TheEndOfAMotionMayBeATenthOff) {
  const auto motions = [](double late) {
    const Trajectory poses = {{0.0, Rigid3()}, {1.0 + late, Rigid3()}};
    return EvaluateRpe(poses, poses).motions;
  };
  EXPECT_EQ(motions(0.09), 1U);
  EXPECT_EQ(motions(-0.09), 1U);
  EXPECT_EQ(motions(0.11), 0U);
  EXPECT_EQ(motions(-0.11), 0U);
}

TEST(Rpe, LongerMotionsDriftMore) {
  const RpeResult report = EvaluateRpe(Drive(31, 1.0), Drive(31, 1.1), {.delta = 2.0});
  EXPECT_NEAR(report.translation.median, 0.2, 1e-9);
  EXPECT_NEAR(report.translation.max, 0.2, 1e-9);
}

}  // namespace
}  // namespace hullslam
