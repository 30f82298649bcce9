// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/measure_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "frame/wall_frame.h"
#include "support/fisheye_camera.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(MeasurePoint, TakesPixelLevelAndDepthOfTheKeypoint) {
  Sensor sensor = SyntheticSensor();
  sensor.depth_error = {.pixel_sigma = 0.5, .adjustment_pixel_sigma = 2.0, .disparity_sigma = 0.25};
  FrameFeatures features;
  for (const double disparity : {20.0, 0.0}) {
    Keypoint& keypoint = features.keypoints.emplace_back();
    keypoint.undistorted = {100.0f, 50.0f};
    keypoint.level = 2;
    features.depth.push_back(disparity > 0.0 ? static_cast<float>(sensor.camera.bf / disparity)
                                             : 0.0f);
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

TEST(MeasurePoint, OfAFisheyeHasTheErrorOfTheRawPixelAndItsDisparity) {
  Sensor sensor = SyntheticSensor();
  sensor.camera = FisheyeCamera();
  FrameFeatures features;
  features.keypoints.resize(1);
  features.keypoints[0].undistorted = sensor.camera.Project({-2.5, 0.5, 1.0}).cast<float>();
  const float depth = 0.8f;
  features.depth = {depth};
  const PointMeasurement measurement = MeasurePoint(sensor, features, 0, sensor.depth_error);
  EXPECT_NEAR(measurement.measured.z(), sensor.camera.bf / 0.8, 1e-3);
  const Eigen::Vector2d raw =
      sensor.camera.Distort(features.keypoints[0].undistorted.cast<double>());
  const Eigen::Vector3d moved = sensor.camera.Unproject(
      sensor.camera.Undistort(raw + Eigen::Vector2d(0.2, 0.1)), sensor.camera.bf / 23.75);
  const double sigma = sensor.depth_error.pixel_sigma;
  EXPECT_NEAR(PointResidual(sensor.camera, measurement, moved).head<2>().norm(),
              std::hypot(0.2, 0.1) / sigma, 0.01);
}

TEST(WideSensor, PixelsAndDepthsAreLessPrecise) {
  const SyntheticWorld world;
  const FrameFeatures features = world.Observe(0).frame->features;
  const Sensor wide = WithWideErrors(world.sensor());
  for (const bool is_adjustment : {false, true}) {
    const auto measure = [&](const Sensor& sensor) {
      return MeasurePoint(sensor, features, 0,
                          is_adjustment ? sensor.depth_error.ForAdjustment() : sensor.depth_error);
    };
    EXPECT_TRUE(measure(wide).inverse_sigma.isApprox(measure(world.sensor()).inverse_sigma /
                                                     kWideErrorFactor));
    EXPECT_EQ(measure(wide).measured, measure(world.sensor()).measured);
  }
}

TEST(DepthSight, APointIsSeenOrSeenPastOrHidden) {
  const Sensor sensor = SyntheticSensor();
  const auto look = [&](double z, double tolerance = 1.0) {
    const Eigen::Vector3d point(0.0, 0.0, z);
    return LookAt(sensor, WallFrame().depth, sensor.camera.Project(point), point, tolerance);
  };
  EXPECT_EQ(look(2.0), Sight::kSurface);
  EXPECT_EQ(look(1.5), Sight::kPast);
  EXPECT_EQ(look(3.0), Sight::kUnclear) << "the wall hides it";
  EXPECT_EQ(look(1.5, 3.0), Sight::kSurface);
}

// The disparities of the plane z = 2 - 0.4 x are 25 + 0.008 (u - cx).
TEST(DisparitySlope, IsThatOfTheSurface) {
  PinholeCamera camera = SyntheticSensor().camera;
  camera.bf = 50.0;
  cv::Mat depth(480, 640, CV_32FC1);
  for (int x = 0; x < depth.cols; ++x) {
    depth.col(x).setTo(50.0 / (25.0 + 0.02 * (x - camera.cx)));
  }
  const auto slope_at = [&](double x, double y) {
    return DisparitySlope(camera, DepthGrid(depth, 1.0), {x, y}, {x, y});
  };
  ASSERT_TRUE(slope_at(300.0, 200.0));
  EXPECT_NEAR(slope_at(300.0, 200.0)->x(), 0.02, 1e-3);  // depths are stored in millimetres
  EXPECT_NEAR(slope_at(300.0, 200.0)->y(), 0.0, 1e-3);
  EXPECT_FALSE(slope_at(700.0, 200.0)) << "outside";
  EXPECT_FALSE(DisparitySlope(camera, {}, {300.0, 200.0}, {300.0, 200.0}));
  depth.at<float>(204, 300) = 0.0F;
  EXPECT_FALSE(slope_at(301.0, 203.0)) << "a sample is unknown";
  depth.at<float>(204, 300) = 1.9F;
  EXPECT_FALSE(slope_at(301.0, 203.0)) << "a sample is of another thing";
  depth.colRange(0, 301).setTo(2.0);
  depth.colRange(301, 640).setTo(1.0);
  EXPECT_FALSE(slope_at(301.0, 203.0)) << "the border of a thing";
}

}  // namespace
}  // namespace hullslam
