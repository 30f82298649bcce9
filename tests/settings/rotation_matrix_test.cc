// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/rotation_matrix.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hullslam
