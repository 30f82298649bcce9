// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/sensor.h"

#include <gtest/gtest.h>

#include "hullslam/camera/depth.h"

namespace hullslam {
namespace {

// The virtual right coordinate of camera/depth.h is the u coordinate of the point in a second
// camera, which is moved along x by the baseline.
TEST(Sensor, BaselineIsThatOfTheVirtualRightCamera) {
  Sensor sensor;
  sensor.camera.fx = 500.0;
  sensor.camera.cx = 320.0;
  sensor.camera.fy = 500.0;
  sensor.camera.bf = 40.0;
  EXPECT_DOUBLE_EQ(sensor.baseline(), 0.08);
  const Eigen::Vector3d in_left(0.3, 0.1, 2.5);
  const Eigen::Vector3d in_right = in_left - Eigen::Vector3d(sensor.baseline(), 0.0, 0.0);
  const auto left_u = static_cast<float>(sensor.camera.Project(in_left).x());
  EXPECT_NEAR(VirtualRight(left_u, 2.5f, sensor.camera.bf), sensor.camera.Project(in_right).x(),
              1e-4);
}

}  // namespace
}  // namespace hullslam
