// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/determination.h"

#include <gtest/gtest.h>

#include <limits>

namespace hullslam {
namespace {

using internal::DeterminesAngles;

// One match that measures the angle and the length with these sigmas.
Eigen::Matrix2d Information(double angle_sigma, double length_sigma) {
  return Eigen::Vector2d(1.0 / (angle_sigma * angle_sigma), 1.0 / (length_sigma * length_sigma))
      .asDiagonal();
}

TEST(DeterminesAngles, ByTheSigmaWithoutTheStrongestMatch) {
  // Two matches of sigma 0.13 have 0.13 / sqrt(2) = 0.092 together.
  const Eigen::Matrix2d weak = Information(0.13, 1.0);
  EXPECT_TRUE(DeterminesAngles<1>(std::vector{weak, weak, weak}));
  EXPECT_FALSE(DeterminesAngles<1>(std::vector{weak, weak}));
  EXPECT_FALSE(DeterminesAngles<1>(std::vector{weak, Information(0.001, 1.0)}));
  EXPECT_FALSE(DeterminesAngles<1>(std::vector{weak, Information(0.001, 100.0)}));
}

TEST(DeterminesAngles, TheOtherParametersMayBeUncertain) {
  const Eigen::Matrix2d match = Information(0.01, 100.0);
  EXPECT_TRUE(DeterminesAngles<1>(std::vector{match, match, match}));
  EXPECT_FALSE(DeterminesAngles<2>(std::vector{match, match, match}));
}

TEST(DeterminesAngles, SingularSumsDetermineNothing) {
  EXPECT_FALSE(DeterminesAngles<1>(std::vector<Eigen::Matrix2d>()));
  EXPECT_FALSE(DeterminesAngles<1>(std::vector<Eigen::Matrix2d>(5, Eigen::Matrix2d::Zero())));
  // The angle cannot be told from the length.
  EXPECT_FALSE(DeterminesAngles<1>(std::vector<Eigen::Matrix2d>(5, Eigen::Matrix2d::Ones())));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(
      DeterminesAngles<1>(std::vector<Eigen::Matrix2d>(5, Eigen::Matrix2d::Constant(nan))));
}

}  // namespace
}  // namespace hullslam
