// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/determination.h"

#include <gtest/gtest.h>

#include <limits>

namespace hullslam {
namespace {

using internal::DetermineParameters;

// One match that measures the angle and the length with these sigmas.
Eigen::Matrix2d Information(double angle_sigma, double length_sigma) {
  return Eigen::Vector2d(1.0 / (angle_sigma * angle_sigma), 1.0 / (length_sigma * length_sigma))
      .asDiagonal();
}

TEST(DetermineParameters, ByTheSigmaWithoutTheStrongestMatch) {
  // Two matches of sigma 0.13 have 0.13 / sqrt(2) = 0.092 together.
  const Eigen::Matrix2d weak = Information(0.13, 1.0);
  EXPECT_TRUE(DetermineParameters(std::vector{weak, weak, weak}, {0}));
  EXPECT_FALSE(DetermineParameters(std::vector{weak, weak}, {0}));
  EXPECT_FALSE(DetermineParameters(std::vector{weak, Information(0.001, 1.0)}, {0}));
  EXPECT_FALSE(DetermineParameters(std::vector{weak, Information(0.001, 100.0)}, {0}));
}

TEST(DetermineParameters, TheOtherParametersMayBeUncertain) {
  const Eigen::Matrix2d match = Information(0.01, 100.0);
  EXPECT_TRUE(DetermineParameters(std::vector{match, match, match}, {0}));
  EXPECT_FALSE(DetermineParameters(std::vector{match, match, match}, {0, 1}));
}

TEST(DetermineParameters, SingularSumsDetermineNothing) {
  EXPECT_FALSE(DetermineParameters(std::vector<Eigen::Matrix2d>(), {0}));
  EXPECT_FALSE(DetermineParameters(std::vector<Eigen::Matrix2d>(5, Eigen::Matrix2d::Zero()), {0}));
  // The matches only measure a sum of the angle and the length.
  EXPECT_FALSE(DetermineParameters(std::vector<Eigen::Matrix2d>(5, Eigen::Matrix2d::Ones()), {0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(
      DetermineParameters(std::vector<Eigen::Matrix2d>(5, Eigen::Matrix2d::Constant(nan)), {0}));
}

}  // namespace
}  // namespace hullslam
