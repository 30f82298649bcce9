// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/keypoint_weights.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "support/synthetic_world.h"
#include "support/unknown_points.h"

namespace hullslam::internal {
namespace {

// A keyframe in which all keypoints show landmarks.
class KeypointWeightsTest : public testing::Test {
 protected:
  struct Seen {
    float u;
    float v;
    int level;
  };

  Keyframe Make(const std::vector<Seen>& seen) const {
    auto frame = std::make_shared<Frame>();
    Keyframe keyframe;
    for (const auto& [u, v, level] : seen) {
      frame->features.keypoints.push_back({.undistorted = {u, v}, .level = level});
      keyframe.landmarks.emplace_back(static_cast<uint32_t>(keyframe.landmarks.size()));
    }
    RebuildGrid(sensor_, *frame);
    keyframe.frame = std::move(frame);
    return keyframe;
  }
  std::vector<double> Shares(const Keyframe& keyframe) const {
    return KeypointWeights(keyframe, sensor_.levels);
  }

  const Sensor sensor_ = SyntheticSensor();
};

TEST_F(KeypointWeightsTest, AllAtOnePositionWeighAsMuchAsTheMostPrecise) {
  const Keyframe keyframe = Make({{100.0f, 80.0f, 2}, {101.5f, 78.0f, 0}, {100.5f, 80.5f, 5}});
  const std::vector<double> weights = Shares(keyframe);
  double together = 0.0;
  for (const size_t i : {0U, 1U, 2U}) {
    const auto level = static_cast<size_t>(keyframe.frame->features.keypoints[i].level);
    together += weights[i] * static_cast<double>(sensor_.levels.inverse_sigma2[level]);
    EXPECT_EQ(weights[i], weights[0]);
  }
  EXPECT_NEAR(together, 1.0, 1e-6) << "the weight of the finest level";
}

TEST_F(KeypointWeightsTest, IsOneForAKeypointWithoutNeighbours) {
  const Keyframe keyframe = Make({{100.0f, 80.0f, 3}, {103.5f, 80.0f, 0}, {100.0f, 76.5f, 0}});
  EXPECT_EQ(Shares(keyframe)[0], 1.0);
}

TEST_F(KeypointWeightsTest, KeypointsWithoutALandmarkDoNotCount) {
  Keyframe keyframe = Make({{100.0f, 80.0f, 1}, {100.0f, 80.0f, 0}});
  EXPECT_LT(Shares(keyframe)[0], 1.0);
  keyframe.landmarks[1] = LandmarkId();
  EXPECT_EQ(Shares(keyframe), (std::vector<double>{1.0, 0.0}));
}

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
