// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_pose.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class YamlPose : public ::testing::Test {
 protected:
  Rigid3 Read(const std::string& pose) {
    folder_.Write("pose.yaml", "T: " + pose);
    return ReadRigid3(YamlMap(folder_.path() / "pose.yaml", "a pose"), "T");
  }

  TemporaryFolder folder_;
};

TEST_F(YamlPose, AllFormsOfAMatrixAreTheSamePose) {
  for (const char* const pose :
       {"[0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1]",
        "[[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]",
        "{cols: 4, rows: 4, data: [0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1]}"}) {
    EXPECT_TRUE((Read(pose) * Eigen::Vector3d(1.0, 0.0, 0.0)).isApprox(Eigen::Vector3d(1, 3, 3)))
        << pose;
  }
}

TEST_F(YamlPose, TheLastRowMayBeMissingWhereThisIsAllowed) {
  folder_.Write("pose.yaml", "T: [0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3]");
  const YamlMap map(folder_.path() / "pose.yaml", "a pose");
  const Rigid3 pose = ReadRigid3(map, "T", RigidRows::kThree);
  EXPECT_TRUE((pose * Eigen::Vector3d(1.0, 0.0, 0.0)).isApprox(Eigen::Vector3d(1, 3, 3)));
  ExpectInputError([&] { ReadRigid3(map, "T"); }, {"pose.yaml:1: T has 12 value(s), expected 16"});
}

TEST_F(YamlPose, OtherMatricesAreRefused) {
  ExpectInputError([&] { Read("[1, 2]"); }, {"pose.yaml:1: T has 2 value(s), expected 16"});
  ExpectInputError([&] { Read("[[1, 2], [3]]"); }, {"pose.yaml:1: T has 3 numbers, expected 16"});
  ExpectInputError([&] { Read("[[1, [2]]]"); },
                   {"pose.yaml:1: T has a value that is not a number"});
  ExpectInputError([&] { Read("7"); }, {"pose.yaml:1: T"});
  ExpectInputError([&] { Read("[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]"); },
                   {"pose.yaml:1: T is not a rigid transform"});
}

}  // namespace
}  // namespace hullslam
