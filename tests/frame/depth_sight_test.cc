// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/depth_sight.h"

#include <gtest/gtest.h>

#include <opencv2/core/mat.hpp>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

constexpr int kWall = 2000;  // mm

// What a camera sees that looks straight at a wall.
Frame WallFrame(int millimetres = kWall) {
  Frame frame;
  frame.depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(millimetres)), 1000.0);
  return frame;
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

}  // namespace
}  // namespace hullslam
