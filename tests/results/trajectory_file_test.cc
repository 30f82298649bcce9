// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/results/trajectory_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/util/check.h"
#include "results/pose_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr const char* kLine = "1.5 1 2 3 0 0 0 1\n";

TEST(TrajectoryFile, ReadsPosesAndNormalisesTheirRotations) {
  const TemporaryFolder folder;
  const Trajectory trajectory =
      ReadTrajectory(folder.Write("t.txt", "# stamp\n1.5 1 2 -3e-1 0 0 2 2\n"));
  ASSERT_EQ(trajectory.size(), 1U);
  EXPECT_EQ(trajectory[0].timestamp, 1.5);
  EXPECT_EQ(trajectory[0].world_from_cam.translation, Eigen::Vector3d(1, 2, -0.3));
  // The file has a rotation by 90 degrees about z.
  const Eigen::Vector3d turned = trajectory[0].world_from_cam.rotation * Eigen::Vector3d::UnitX();
  EXPECT_LT((turned - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(TrajectoryFile, TheLastOfEqualStampsIsUsed) {
  const TemporaryFolder folder;
  const Trajectory trajectory =
      ReadTrajectory(folder.Write("t.txt", std::string(kLine) + "1.5 7 0 0 0 0 0 1\n"));
  ASSERT_EQ(trajectory.size(), 1U);
  EXPECT_EQ(trajectory[0].world_from_cam.translation.x(), 7.0);
}

TEST(TrajectoryFile, WritesFixedDecimals) {
  const Trajectory trajectory = {
      {1305031102.1753, Rigid3(Eigen::Quaterniond(-1, 0, 0, 0), {1.0 / 3.0, -2.0, -4.9e-10})}};
  EXPECT_EQ(FormatTrajectory(trajectory),
            "# timestamp tx ty tz qx qy qz qw\n"
            "1305031102.175300 0.333333333 -2.000000000 0.000000000 "
            "0.000000000 0.000000000 0.000000000 1.000000000\n");
}

TEST(TrajectoryFile, ReadingInvertsWriting) {
  const TemporaryFolder folder;
  Trajectory trajectory;
  for (int i = 0; i < 100; ++i) {
    trajectory.push_back({1305031102.0 + 0.033 * i,
                          Rigid3(ExpSo3({0.1 * i, -0.05 * i, 0.02 * i}), {0.01 * i, 1.0, -2.0})});
  }
  const Trajectory again = ReadTrajectory(folder.Write("t.txt", FormatTrajectory(trajectory)));
  ASSERT_EQ(again.size(), trajectory.size());
  for (size_t i = 0; i < again.size(); ++i) {
    EXPECT_NEAR(again[i].timestamp, trajectory[i].timestamp, 1e-6);
    EXPECT_LT(
        (again[i].world_from_cam.translation - trajectory[i].world_from_cam.translation).norm(),
        1e-8);
    EXPECT_LT(
        AngularDistance(again[i].world_from_cam.rotation, trajectory[i].world_from_cam.rotation),
        1e-7);
    EXPECT_GE(again[i].world_from_cam.rotation.w(), 0.0);
  }
}

TEST(TrajectoryFile, BrokenLinesAreReported) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& line, const std::vector<std::string>& parts) {
    const auto path = folder.Write("bad.txt", "# head\n" + std::string(kLine) + line + "\n");
    ExpectInputError([&] { ReadTrajectory(path); }, parts);
  };
  expect("2.0 nan 0 0 0 0 0 1", {"bad.txt:3:", "tx is 'nan'", "finite number"});
  expect("2.0 0 0 0 0 0 0 NaN", {"bad.txt:3:", "qw is 'NaN'"});
  expect("inf 0 0 0 0 0 0 1", {"bad.txt:3:", "timestamp is 'inf'"});
  expect("2.0 0 0 0 0 0 1", {"bad.txt:3:", "7 columns", "expected 8"});
  expect("2.0 0 0 0 0 0 0 1 5", {"bad.txt:3:", "9 columns"});
  expect("2.0 0 0 0 0 0 0 0", {"bad.txt:3:", "length 0", "a rotation"});
  expect("1.4 0 0 0 0 0 0 1", {"bad.txt:3:", "1.400000", "before", "1.500000"});
  expect("2.0 0 0 0 0 0 0 1e200", {"bad.txt:3:", "length inf"});
  expect("2.0 0 0 0 0 1e-9 0 0", {"bad.txt:3:", "length 1e-09"});
  expect("2.0 0 1e155 0 0 0 0 1", {"bad.txt:3:", "ty is '1e155'", "from -1e+08 to 1e+08"});
  expect("1305031102175304 0 0 0 0 0 0 1", {"bad.txt:3:", "a time in seconds"});
  expect("2.0 0 0 a 0 0 0 1", {"bad.txt:3:", "tz is 'a'"});
}

TEST(TrajectoryFile, KeyframesOfAnEarlierSessionMayHaveLaterStamps) {
  const TemporaryFolder folder;
  const std::string row = " 0 0 0 0 0 0 1\n";
  const auto path =
      folder.Write("keyframes.txt", "# first\n5" + row + "6" + row + "# second\n5" + row);
  ASSERT_EQ(ReadKeyframes(path).size(), 3u);
  EXPECT_EQ(ReadKeyframes(path)[2].timestamp, 5.0);
  ExpectInputError([&] { ReadKeyframes(folder.Write("empty.txt", "# nothing\n")); },
                   {"empty.txt", "has no poses"});
  ExpectInputError([&] { ReadKeyframes(folder.Write("bad.txt", "5 0 0\n")); }, {"bad.txt:1"});
}

TEST(TrajectoryFile, FilesWithoutPosesAreRefused) {
  const TemporaryFolder folder;
  ExpectInputError([&] { ReadTrajectory(folder.Write("empty.txt", "")); },
                   {"empty.txt", "no pose"});
  ExpectInputError([&] { ReadTrajectory(folder.Write("head.txt", "# a\n")); }, {"no poses"});
  ExpectInputError([&] { ReadTrajectory(folder.path() / "none.txt"); }, {"none.txt"});
  ExpectInputError(
      [&] {
        ReadTrajectory(folder.Write("binary",
                                    "\x7f"
                                    "ELF\x01\x02"));
      },
      {"binary:1:"});
}

TEST(TrajectoryFile, NonFiniteValuesAreNeverWritten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Trajectory trajectory = {{1.0, Rigid3(Eigen::Quaterniond::Identity(), {nan, 0, 0})}};
  EXPECT_THROW(FormatTrajectory(trajectory), CheckError);
}

TEST(TrajectoryFile, AWrittenFileHasTheFormattedText) {
  const TemporaryFolder folder;
  const Trajectory trajectory = {{1.0, Rigid3(Eigen::Quaterniond::Identity(), {1.0, 2.0, 3.0})}};
  WriteTrajectory(folder.path() / "a.txt", trajectory);
  EXPECT_EQ(FormatTrajectory(ReadTrajectory(folder.path() / "a.txt")),
            FormatTrajectory(trajectory));
  ExpectInputError([&] { WriteTrajectory(folder.path() / "none" / "a.txt", trajectory); },
                   {"none/a.txt"});
}

TEST(TrajectoryFile, PartsHaveATitle) {
  const StampedPose pose{.timestamp = 1.5, .world_from_cam = {}};
  const Trajectory one = {pose};
  const std::string line =
      "1.500000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 "
      "0.000000000 1.000000000\n";
  const std::string head = "# timestamp tx ty tz qx qy qz qw\n";
  EXPECT_EQ(FormatTrajectory(one), head + line);
  const std::vector<TrajectoryPart> parts = {
      {{}, one}, {"session 1: desk", one}, {"session 2: a\nroom", {}}};
  EXPECT_EQ(FormatTrajectory(parts),
            head + line + "# session 1: desk\n" + line + "# session 2: a?room\n");
}

// A trajectory to other readers, and each covariance as it was.
TEST(LivePoses, AreReadWithTheirCovariances) {
  TrackedFrame frame;
  frame.timestamp = 1.5;
  frame.state = TrackingState::kTracked;
  frame.cam_from_world.translation = {-1.0, -2.0, -3.0};
  frame.covariance = Eigen::Matrix<double, 6, 6>::Identity();
  (*frame.covariance)(0, 5) = (*frame.covariance)(5, 0) = 0.25;
  frame.odometry.emplace().corrected_at = FrameId(7);
  TrackedFrame lost = frame;
  lost.state = TrackingState::kLost;
  lost.timestamp = 2.0;
  const TemporaryFolder folder;
  const PoseFile file = ReadPoseFile(
      folder.Write("live_poses.txt", FormatLivePoses(std::vector<TrackedFrame>{frame, lost})));
  ASSERT_EQ(file.poses.size(), 1U);
  EXPECT_EQ(file.poses[0].world_from_cam.translation, Eigen::Vector3d(1.0, 2.0, 3.0));
  ASSERT_EQ(file.covariances.size(), 1U);
  EXPECT_EQ(file.covariances[0], *frame.covariance);
}

}  // namespace
}  // namespace hullslam
