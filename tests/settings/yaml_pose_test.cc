// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_pose.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(RotationMatrix, IsReadWithTheRoundingOfFiles) {
  const Eigen::Quaterniond rotation(
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()));
  const Eigen::Matrix3d exact = rotation.toRotationMatrix();
  const Eigen::Matrix3d rounded = (1e4 * exact).array().round() / 1e4;
  const auto read = RotationOf(rounded);
  ASSERT_TRUE(read.has_value());
  EXPECT_NEAR(read->norm(), 1.0, 1e-12);
  EXPECT_LT(read->angularDistance(rotation), 1e-3);
}

TEST(RotationMatrix, OtherMatricesAreNone) {
  EXPECT_FALSE(RotationOf(Eigen::Matrix3d::Zero()).has_value());
  EXPECT_FALSE(RotationOf(-Eigen::Matrix3d::Identity()).has_value()) << "a mirror";
  EXPECT_FALSE(RotationOf(1.01 * Eigen::Matrix3d::Identity()).has_value());
  Eigen::Matrix3d sheared = Eigen::Matrix3d::Identity();
  sheared(0, 1) = 0.1;
  EXPECT_FALSE(RotationOf(sheared).has_value());
}

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

class YamlLens : public ::testing::Test {
 protected:
  PinholeCamera Read(const std::string& text) {
    folder_.Write("lens.yaml", text);
    PinholeCamera camera;
    ReadLens(YamlMap(folder_.path() / "lens.yaml", "a lens"), "model", "numbers", camera);
    return camera;
  }

  TemporaryFolder folder_;
};

TEST_F(YamlLens, IsReadByItsName) {
  const PinholeCamera camera = Read("model: equidistant\nnumbers: [0.1, 0.2, 0.3, 0.4]\n");
  EXPECT_TRUE(camera.IsFisheye());
  EXPECT_EQ(camera.k4, 0.4);
}

TEST_F(YamlLens, FaultsNameTheLineAndWhatWasExpected) {
  ExpectInputError([&] { Read("model: omni\nnumbers: [0.1, 0.2, 0.3, 0.4]\n"); },
                   {"lens.yaml:1: model is 'omni' and numbers has 4 number(s)", "expected plumb"});
  ExpectInputError([&] { Read("model: equidistant\nnumbers: [0.1]\n"); },
                   {"lens.yaml:1: model", "1 number(s), expected 4 coefficients"});
  ExpectInputError([&] { Read("model: radtan\nnumbers: 0.1\n"); },
                   {"lens.yaml:2: numbers is not a list of numbers"});
  ExpectInputError([&] { Read("model: radtan\nnumbers: [0.1, x]\n"); }, {"lens.yaml:2: numbers"});
  ExpectInputError([&] { Read("model: radtan\n"); }, {"numbers is not given"});
  ExpectInputError([&] { Read("numbers: [0.1]\n"); }, {"model is not given"});
}

}  // namespace

}  // namespace hullslam
