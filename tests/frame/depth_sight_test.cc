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

}  // namespace
}  // namespace hullslam
