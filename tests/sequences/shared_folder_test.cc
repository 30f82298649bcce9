// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/shared_folder.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hullslam/sequences/tum_sequence.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// A rotation by 90 degrees about z, in 7-Scenes' separators, and a translation.
std::string Matrix(double x, const std::string& end = "\n") {
  return "0.0\t -1.0\t 0.0\t " + std::to_string(x) + "\t" + end + "1.0\t 0.0\t 0.0\t 2.0\t" + end +
         "0.0\t 0.0\t 1.0\t 3.0\t" + end + "0.0\t 0.0\t 0.0\t 1.0\t\n";
}

class SharedFolderTest : public ::testing::Test {
 protected:
  void Add7Scenes(int frames) {
    for (int i = 0; i < frames; ++i) {
      const std::string name = "frame-00000" + std::to_string(i);
      folder_.Write(name + ".color.png", "");
      folder_.Write(name + ".depth.png", "");
      folder_.Write(name + ".pose.txt", Matrix(i));
    }
  }
  void AddReplica(int frames) {
    for (int i = 0; i < frames; ++i) {
      folder_.Write("results/frame00000" + std::to_string(i) + ".jpg", "");
      folder_.Write("results/depth00000" + std::to_string(i) + ".png", "");
    }
  }
  ImageSequence Open(const FrameSelection& selection = {}) {
    return OpenTumSequence(folder_.path(), {.frames_per_second = 10.0, .selection = selection});
  }
  static void ExpectPoses(const ImageSequence& sequence, const std::vector<int>& numbers) {
    ASSERT_TRUE(sequence.converted_groundtruth);
    const Trajectory& poses = *sequence.converted_groundtruth;
    ASSERT_EQ(poses.size(), numbers.size());
    for (size_t i = 0; i < poses.size(); ++i) {
      const Rigid3& pose = poses[i].world_from_cam;
      EXPECT_DOUBLE_EQ(poses[i].timestamp, numbers[i] / 10.0);
      EXPECT_TRUE(pose.translation.isApprox(Eigen::Vector3d(numbers[i], 2.0, 3.0)));
      EXPECT_TRUE((pose.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
    }
  }

  TemporaryFolder folder_;
};

TEST_F(SharedFolderTest, PosesOf7ScenesAreBesideTheImages) {
  Add7Scenes(6);
  ExpectPoses(Open(), {0, 1, 2, 3, 4, 5});
  ExpectPoses(Open({.first = 1, .last = 5, .stride = 2}), {1, 3, 5});
}

TEST_F(SharedFolderTest, FramesWithoutAPoseOf7ScenesAreCounted) {
  Add7Scenes(5);
  std::filesystem::remove(folder_.path() / "frame-000001.pose.txt");
  folder_.Write("frame-000002.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  folder_.Write("frame-000003.pose.txt", "-1.#IND -1.#IND -1.#IND -1.#IND\n" + Matrix(1));
  const ImageSequence sequence = Open();
  ExpectPoses(sequence, {0, 4});
  ASSERT_EQ(sequence.warnings.size(), 1U);
  EXPECT_NE(sequence.warnings[0].find("3 of 5 frames have no true pose"), std::string::npos);
  EXPECT_NE(sequence.warnings[0].find("frame-000001.pose.txt"), std::string::npos);
}

TEST_F(SharedFolderTest, PosesOfReplicaAreTheRowsOfTraj) {
  AddReplica(4);
  folder_.Write("traj.txt", Matrix(0, " ") + Matrix(1, " ") + Matrix(2, " ") + Matrix(3, " "));
  ExpectPoses(Open(), {0, 1, 2, 3});
  ExpectPoses(Open({.first = 1, .last = 3, .stride = 2}), {1, 3});
}

// A row that is left out does not move the poses of the rows behind it.
TEST_F(SharedFolderTest, RowsOfReplicaBelongToTheNumbersOfFrames) {
  AddReplica(4);
  folder_.Write("traj.txt", Matrix(0, " ") + Matrix(1, " ") + "nan 0 0\n" + Matrix(3, " "));
  const ImageSequence sequence = Open();
  ExpectPoses(sequence, {0, 1, 3});
  ASSERT_EQ(sequence.warnings.size(), 1U);
  EXPECT_NE(sequence.warnings[0].find("1 of 4 frames have no true pose"), std::string::npos);
  EXPECT_NE(sequence.warnings[0].find("traj.txt: row 3 has no pose"), std::string::npos);
}

TEST_F(SharedFolderTest, PosesThatCannotBeUsedDoNotStopARun) {
  AddReplica(3);
  EXPECT_FALSE(Open().converted_groundtruth);
  EXPECT_TRUE(Open().warnings.empty());
  folder_.Write("traj.txt", "a mirror\n-1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n");
  const ImageSequence sequence = Open();
  EXPECT_FALSE(sequence.converted_groundtruth);
  ASSERT_EQ(sequence.warnings.size(), 1U);
  EXPECT_NE(sequence.warnings[0].find("3 of 3 frames have no true pose"), std::string::npos);
  EXPECT_NE(sequence.warnings[0].find("no matrix of a pose"), std::string::npos);
}

TEST_F(SharedFolderTest, AGroundtruthFileIsPreferred) {
  Add7Scenes(2);
  folder_.Write("groundtruth.txt", "0 0 0 0 0 0 0 1\n");
  EXPECT_FALSE(Open().converted_groundtruth);
  EXPECT_EQ(Open().groundtruth, folder_.path() / "groundtruth.txt");
}

}  // namespace
}  // namespace hullslam
