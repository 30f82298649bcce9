// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/intrinsics.h"

#include <gtest/gtest.h>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

// The costs' projection is that of the camera.
TEST(Intrinsics, ProjectAsTheCamera) {
  const PinholeCamera camera{.fx = 517.3, .fy = 516.5, .cx = 318.6, .cy = 255.3, .bf = 39.0};
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.0);
    const Eigen::Vector3d projected = ProjectRgbd(ToIntrinsics(camera), point);
    EXPECT_LT((projected.head<2>() - camera.Project(point)).norm(), 1e-10);
    EXPECT_NEAR(projected.z(), 39.0 / point.z(), 1e-10);
  }
}

}  // namespace
}  // namespace hullslam
