// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/depth_sight.h"

#include <gtest/gtest.h>

#include "frame/wall_frame.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

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
    return DisparitySlope(camera, DepthGrid(depth, 1.0), {x, y});
  };
  ASSERT_TRUE(slope_at(300.0, 200.0));
  EXPECT_NEAR(slope_at(300.0, 200.0)->x(), 0.02, 1e-3);  // depths are stored in millimetres
  EXPECT_NEAR(slope_at(300.0, 200.0)->y(), 0.0, 1e-3);
  EXPECT_FALSE(slope_at(700.0, 200.0)) << "outside";
  EXPECT_FALSE(DisparitySlope(camera, {}, {300.0, 200.0}));
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
