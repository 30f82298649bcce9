// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/keypoint_precision.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace hullslam::internal {
namespace {

// 201 errors with this median. Without points, all equations are free.
std::vector<double> ErrorsWithMedian(double median) {
  std::vector<double> chi2;
  for (int i = 0; i <= 200; ++i) {
    chi2.push_back(median * i / 100.0);
  }
  return chi2;
}

constexpr double kMedianOfChi2 = 2.0 * std::numbers::ln2;

TEST(MeasureKeypointPrecision, IsTheInverseOfTheStandardDeviationThatTheErrorsShow) {
  EXPECT_NEAR(MeasureKeypointPrecision(ErrorsWithMedian(kMedianOfChi2 / 4.0), 0, 1.0), 2.0, 1e-3);
  EXPECT_NEAR(MeasureKeypointPrecision(ErrorsWithMedian(kMedianOfChi2 / 9.0), 0, 1.0), 3.0, 1e-3);
}

TEST(MeasureKeypointPrecision, TheUnitOfTheErrorsDoesNotMatter) {
  // The same errors in units of half the standard deviation are twice as large.
  EXPECT_NEAR(MeasureKeypointPrecision(ErrorsWithMedian(kMedianOfChi2), 0, 2.0), 2.0, 1e-3);
}

TEST(MeasureKeypointPrecision, PointsMakeTheErrorsSmaller) {
  const double free_share = 1.0 - 3.0 * 89.0 / 402.0;
  const double median = kMedianOfChi2 * free_share / 4.0;
  EXPECT_NEAR(MeasureKeypointPrecision(ErrorsWithMedian(median), 89, 1.0), 2.0, 1e-3);
}

TEST(MeasureKeypointPrecision, HasBounds) {
  EXPECT_EQ(MeasureKeypointPrecision(ErrorsWithMedian(100.0), 0, 1.0), 1.0);
  EXPECT_EQ(MeasureKeypointPrecision(ErrorsWithMedian(1e-6), 0, 1.0), 5.0);
}

TEST(MeasureKeypointPrecision, IsNotMeasuredByFewErrors) {
  EXPECT_EQ(MeasureKeypointPrecision(std::vector<double>(99, 0.1), 0, 1.5), 1.5);
  EXPECT_NE(MeasureKeypointPrecision(std::vector<double>(100, 0.1), 0, 1.5), 1.5);
}

TEST(OutlierBoundFactor, IsTwoButNeverBeyondTheBoundOfTheSensor) {
  EXPECT_EQ(OutlierBoundFactor(3.0), 2.0);
  EXPECT_EQ(OutlierBoundFactor(1.2), 1.2 * 1.2);
  EXPECT_EQ(OutlierBoundFactor(1.0), 1.0);
}

}  // namespace
}  // namespace hullslam::internal
