// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sstream>

#include "exports/single_files.h"
#include "sequences/euroc_states.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

Trajectory MadePoses() {
  return {{1305031102.175304, Rigid3(ExpSo3({0.1, 0.2, 0.3}), {1.0, -2.0, 3.5})},
          {1305031102.211214, Rigid3(ExpSo3({-0.5, 0.0, 0.0}), {0.0, 1e-7, -4.0})}};
}

TEST(KittiPoses, AreTheRowsOfTheMatrix) {
  const Trajectory poses = MadePoses();
  std::istringstream lines(FormatKittiPoses(poses));
  for (const StampedPose& pose : poses) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream numbers(line);
    const Eigen::Matrix<double, 3, 4> matrix = pose.world_from_cam.ToMatrix();
    for (Eigen::Index i = 0; i < 12; ++i) {
      double number = 0.0;
      ASSERT_TRUE(numbers >> number);
      EXPECT_NEAR(number, matrix(i / 4, i % 4), 1e-8);
    }
    EXPECT_FALSE(numbers >> line) << "more than 12 numbers";
  }
}

TEST(EurocPoses, AreReadByTheReaderOfEuroc) {
  const TemporaryFolder folder;
  const Trajectory poses = MadePoses();
  const std::string text = FormatEurocPoses(poses);
  EXPECT_TRUE(text.starts_with("#timestamp [ns], p_RS_R_x [m]"));
  EXPECT_NE(text.find("\n1305031102175304000,1.0"), std::string::npos);
  const Trajectory read = ReadEurocStates(folder.Write("data.csv", text), Rigid3());
  ASSERT_EQ(read.size(), poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(read[i].timestamp, poses[i].timestamp, 1e-6);
    const Rigid3& expected = poses[i].world_from_cam;
    EXPECT_NEAR((read[i].world_from_cam.translation - expected.translation).norm(), 0.0, 1e-8);
    EXPECT_NEAR(AngularDistance(read[i].world_from_cam.rotation, expected.rotation), 0.0, 1e-7);
  }
}

}  // namespace
}  // namespace hullslam
