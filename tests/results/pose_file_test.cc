// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/pose_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class PoseFileTest : public ::testing::Test {
 protected:
  PoseFile Read(const std::string& text) const { return ReadPoseFile(folder_.Write("gt", text)); }
  // Expects the two poses of all files below: a quarter turn about z, at 1305031102.25 and .5 s.
  void ExpectPoses(const PoseFile& file, double first = 1305031102.25) const {
    ASSERT_EQ(file.poses.size(), 2U);
    EXPECT_NEAR(file.poses[0].timestamp, first, 1e-6);
    EXPECT_NEAR(file.poses[1].timestamp, first + 0.25, 1e-6);
    for (const StampedPose& pose : file.poses) {
      EXPECT_TRUE(pose.world_from_cam.rotation.isApprox(kTurn, 1e-6));
    }
    EXPECT_EQ(file.poses[0].world_from_cam.translation, Eigen::Vector3d(1.0, 2.0, 3.0));
    EXPECT_EQ(file.poses[1].world_from_cam.translation, Eigen::Vector3d(4.0, 5.0, 6.0));
  }

  const Eigen::Quaterniond kTurn = Eigen::Quaterniond(0.8, 0.0, 0.0, 0.6);
  TemporaryFolder folder_;
};

TEST_F(PoseFileTest, TheFormsOfOtherProgramsGiveTheSamePoses) {
  const std::string plain = "1305031102.25 1 2 3 0 0 0.6 0.8\n1305031102.5 4 5 6 0 0 0.6 0.8\n";
  ExpectPoses(Read(plain));
  EXPECT_TRUE(Read(plain).notes.empty());
  ExpectPoses(Read("\xef\xbb\xbf# timestamp tx ty tz qx qy qz qw\r\n" + plain));
  ExpectPoses(Read("timestamp tx ty tz qx qy qz qw\n" + plain));
  ExpectPoses(
      Read("num t x y z qx qy qz qw\n0 1305031102.25 1 2 3 0 0 0.6 0.8\n"
           "1 1305031102.5 4 5 6 0 0 0.6 0.8\n"));
  ExpectPoses(
      Read("ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw\n1305031102250000000,1,2,3,0,0,0.6,"
           "0.8\n1305031102500000000,4,5,6,0,0,0.6,0.8\n"));
  ExpectPoses(
      Read("#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x "
           "[], q_RS_y [], q_RS_z []\n1305031102250000000,1,2,3,0.8,0,0,0.6\n"
           "1305031102500000000,4,5,6,0.8,0,0,0.6\n"));
  const std::string rest(",0,0,0,0,0,0,0,0,0\n");
  ExpectPoses(Read("1305031102250000000,1,2,3,0.8,0,0,0.6" + rest.substr(0, 18) +
                   "\n1305031102500000000,4,5,6,0.8,0,0,0.6" + rest));
  ExpectPoses(Read("1305031102.25;1;2;3;0;0;0.6;0.8\n1305031102.5;4;5;6;0;0;0.6;0.8\n"));
}

TEST_F(PoseFileTest, StampsInOtherUnitsAreKnownByTheirSize) {
  for (const std::string zeros : {"", "000", "000000"}) {
    const PoseFile file = Read("1305031102250" + zeros + " 1 2 3 0 0 0.6 0.8\n1305031102500" +
                               zeros + " 4 5 6 0 0 0.6 0.8\n");
    ExpectPoses(file);
    ASSERT_EQ(file.notes.size(), 1U);
    EXPECT_NE(file.notes[0].find("seconds"), std::string::npos);
  }
  // Small stamps are nanoseconds if the header says so.
  ExpectPoses(Read("#t [ns] x y z qx qy qz qw\n1000000000 1 2 3 0 0 0.6 0.8\n"
                   "1250000000 4 5 6 0 0 0.6 0.8\n"),
              1.0);
}

TEST_F(PoseFileTest, PosesOfKittiGetTheStampsOfAsManyFrames) {
  const std::string first = "0.28 -0.96 0 1 0.96 0.28 0 2 0 0 1 3";
  const std::string second = "0.28 -0.96 0 4 0.96 0.28 0 5 0 0 1 6";
  for (const std::string end : {"\n", " 0 0 0 1\n"}) {
    PoseFile file = Read(first + end + second + end);
    EXPECT_FALSE(file.has_stamps);
    SetStamps("gt", std::vector<double>{1305031102.25, 1305031102.5}, file);
    EXPECT_TRUE(file.has_stamps);
    ExpectPoses(file);
    ExpectInputError([&] { SetStamps("gt", std::vector<double>{1.0}, file); },
                     {"gt: its 2 poses have no time stamps", "1 to compare with", "times.txt"});
  }
  folder_.Write("times.txt", "1305031102.25\n1305031102.5\n");
  ExpectPoses(Read(first + '\n' + second + '\n'));
  ExpectInputError([&] { Read("2 0 0 1 0 1 0 2 0 0 1 3\n"); }, {"gt:1: ", "no matrix of a pose"});
}

TEST_F(PoseFileTest, SingleFaultyRowsAreSkippedAndCounted) {
  const std::string plain = "1305031102.25 1 2 3 0 0 0.6 0.8\n1305031102.5 4 5 6 0 0 0.6 0.8\n";
  const PoseFile file =
      Read("1305031102.1 NaN NaN NaN NaN NaN NaN NaN\n" + plain + "1305031103 1 2");
  ExpectPoses(file);
  ASSERT_EQ(file.notes.size(), 1U);
  EXPECT_NE(file.notes[0].find("2 of 4 rows are skipped"), std::string::npos) << file.notes[0];
  EXPECT_NE(file.notes[0].find("gt:1: qw is 'NaN'"), std::string::npos) << file.notes[0];
  const PoseFile two = Read(plain + plain);
  ExpectPoses(two);
  ASSERT_EQ(two.notes.size(), 1U);
  EXPECT_NE(two.notes[0].find("1 of 4 rows are skipped"), std::string::npos) << two.notes[0];
  EXPECT_NE(two.notes[0].find("line 3"), std::string::npos) << two.notes[0];
  ExpectPoses(Read("1305031102.25 1 2 3 0 0 0.6 0.8\n" + plain));  // a repeated row
}

// 6 of 447 rows would remain, and with them an error of 17 cm that means nothing.
TEST_F(PoseFileTest, StampsThatWereRoundedToSecondsAreRefused) {
  std::string text;
  for (int i = 0; i < 60; ++i) {
    text += std::to_string(1305031102 + i / 30) + " " + std::to_string(i) + " 2 3 0 0 0 1\n";
  }
  ExpectInputError([&] { Read(text); },
                   {"gt: 60 poses have only 2 different time stamps", "digits"});
}

TEST_F(PoseFileTest, OtherFilesAreRefused) {
  ExpectInputError([&] { Read(""); }, {"gt: has no poses"});
  ExpectInputError([&] { Read("hello\n"); }, {"gt:1: 1 columns, expected 8"});
  ExpectInputError([&] { Read("1 2 3 4 5 6 7 8 9\n"); }, {"gt:1: 9 columns"});
  ExpectInputError([&] { Read("1305031102,25;1;2;3;0;0;0,6;0,8\n"); }, {"gt:1: ", "decimal"});
  ExpectInputError([&] { Read("1 1 2 3 0 0 0 0\n2 1 2 3 0 0 0 0\n"); }, {"gt:1: ", "length 0"});
}

// Matrices behind the numbers of frames, of which some are missing. Files of EuRoC have as many
// columns.
TEST_F(PoseFileTest, NumberedMatricesAreThoseOfKitti360) {
  for (const std::string end : {"", " 0 0 0 1", " 0.000 0.000 0.000 1.000"}) {
    const PoseFile file = Read("1 0.28 -0.96 0 1 0.96 0.28 0 2 0 0 1 3" + end +
                               "\n4 0.28 -0.96 0 4 0.96 0.28 0 5 0 0 1 6" + end + "\n");
    EXPECT_FALSE(file.has_stamps);
    EXPECT_TRUE(file.has_numbers);
    ASSERT_EQ(file.poses.size(), 2U);
    EXPECT_EQ(file.poses[1].timestamp, 4.0);
    EXPECT_EQ(file.poses[1].world_from_cam.translation, Eigen::Vector3d(4.0, 5.0, 6.0));
    EXPECT_TRUE(file.poses[1].world_from_cam.rotation.isApprox(kTurn, 1e-6));
    PoseFile stamped = file;
    EXPECT_FALSE(FitsFrames(stamped, 4));
    const std::vector<double> stamps = {10.0, 10.1, 10.2, 10.3, 10.4, 10.5};
    SetStamps("poses.txt", stamps, stamped);
    EXPECT_EQ(stamped.poses[0].timestamp, 10.1);
    EXPECT_EQ(stamped.poses[1].timestamp, 10.4);
    ExpectInputError(
        [&] {
          PoseFile again = file;
          SetStamps("poses.txt", std::vector<double>(4), again);
        },
        {"poses.txt", "numbers up to 4"});
  }
}

TEST_F(PoseFileTest, NumberedMatricesGetTheStampsOfTimes) {
  folder_.Write("times.txt", "0.0\n0.1\n0.2\n0.3\n0.4\n");
  const PoseFile file = Read("1 1 0 0 1 0 1 0 2 0 0 1 3\n4 1 0 0 4 0 1 0 5 0 0 1 6\n");
  EXPECT_TRUE(file.has_stamps);
  EXPECT_EQ(file.poses[0].timestamp, 0.1);
  EXPECT_EQ(file.poses[1].timestamp, 0.4);
}

// A camera at (1, 2, 3) that looks along x of the world, with z down.
TEST_F(PoseFileTest, PosesOfTartanAirHaveTheAxesOfOurCameras) {
  const PoseFile file =
      ReadPoseFile(folder_.Write("pose_left.txt", "1 2 3 0 0 0 1\n4 5 6 0 0 0 1\n"));
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_FALSE(file.has_stamps);
  EXPECT_EQ(file.poses[1].timestamp, 1.0);
  const Rigid3& pose = file.poses[0].world_from_cam;
  EXPECT_EQ(pose.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_LT((pose.rotation * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((pose.rotation * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST_F(PoseFileTest, ColumnsThatAreNoQuaternionAreRefused) {
  const std::string rest(" 0 0 0 0 0 0 0 0 0\n");
  ExpectInputError([&] { Read("100 1 2 3 7.5 0.1 0.2 0.3" + rest); },
                   {"columns 5 to 8", "no quaternion", "expected 1"});
  ExpectInputError([&] { Read("1.5 0 0 0 1 1 2 3\n"); }, {"columns 5 to 8", "3.87"});
  EXPECT_EQ(Read("1.5 0 0 0 0 0 0.01 0.99\n").poses.size(), 1U) << "rounded";
  // Numbers that are no whole ones are no numbers of frames.
  ExpectInputError([&] { Read("0.5 1 0 0 1 0 1 0 2 0 0 1 3\n"); }, {"13 columns", "KITTI-360"});
}

}  // namespace
}  // namespace hullslam
