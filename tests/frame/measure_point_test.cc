// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/measure_point.h"

#include <gtest/gtest.h>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(MeasurePoint, TakesPixelLevelAndDepthOfTheKeypoint) {
  Sensor sensor = SyntheticSensor();
  sensor.depth_error = {.pixel_sigma = 0.5, .adjustment_pixel_sigma = 2.0, .disparity_sigma = 0.25};
  FrameFeatures features;
  for (const float right_u : {80.0f, -1.0f}) {
    Keypoint& keypoint = features.keypoints.emplace_back();
    keypoint.undistorted = {100.0f, 50.0f};
    keypoint.level = 2;
    features.right_u.push_back(right_u);
  }
  const double inverse_sigma = 2.0 / static_cast<double>(sensor.levels.scale[2]);

  const PointMeasurement with_depth = MeasurePoint(sensor, features, 0, sensor.depth_error);
  EXPECT_EQ(with_depth.measured, Eigen::Vector3d(100.0, 50.0, 20.0));
  EXPECT_EQ(with_depth.inverse_sigma, Eigen::Vector3d(inverse_sigma, inverse_sigma, 4.0));

  const PointMeasurement without_depth = MeasurePoint(sensor, features, 1, sensor.depth_error);
  EXPECT_EQ(without_depth.measured.head<2>(), Eigen::Vector2d(100.0, 50.0));
  EXPECT_EQ(without_depth.inverse_sigma, Eigen::Vector3d(inverse_sigma, inverse_sigma, 0.0));
}

TEST(MeasurePoint, BundleAdjustmentHasAPixelErrorOfItsOwn) {
  const DepthErrorOptions options{
      .pixel_sigma = 0.5, .adjustment_pixel_sigma = 2.0, .disparity_sigma = 0.25};
  EXPECT_EQ(options.ForAdjustment().pixel_sigma, 2.0);
  EXPECT_EQ(options.ForAdjustment().disparity_sigma, 0.25);
}

}  // namespace
}  // namespace hullslam
