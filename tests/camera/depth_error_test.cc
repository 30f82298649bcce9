// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/depth_error.h"

#include <gtest/gtest.h>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

constexpr PinholeCamera kCamera{.fx = 500.0, .fy = 400.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

TEST(Projection, ByHand) {
  const Eigen::Vector3d point(1.0, -0.5, 2.0);
  EXPECT_EQ(ProjectRgbd(kCamera, point), Eigen::Vector3d(570.0, 140.0, 20.0));
  Eigen::Matrix3d expected;
  expected << 250.0, 0.0, -125.0, 0.0, 200.0, 50.0, 0.0, 0.0, -10.0;
  EXPECT_LT((ProjectRgbdJacobian(kCamera, point) - expected).norm(), 1e-12);
}

TEST(Projection, PixelIsThatOfTheCamera) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.0);
    EXPECT_LT((ProjectRgbd(kCamera, point).head<2>() - kCamera.Project(point)).norm(), 1e-10);
  }
}

TEST(Projection, DerivativeIsTrue) {
  RandomGeometry random(1);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.5);
    const Eigen::Matrix3d jacobian = ProjectRgbdJacobian(kCamera, point);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d slope =
          (ProjectRgbd(kCamera, point + step) - ProjectRgbd(kCamera, point - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-5);
    }
  }
}

TEST(Projection, PixelDoesNotChangeAlongTheRayAndDisparityFallsWithDepth) {
  RandomGeometry random(2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.5);
    const Eigen::Vector3d near = ProjectRgbd(kCamera, point);
    const Eigen::Vector3d far = ProjectRgbd(kCamera, 3.0 * point);
    EXPECT_LT((near.head<2>() - far.head<2>()).norm(), 1e-10);
    EXPECT_NEAR(near.z(), 3.0 * far.z(), 1e-10);
  }
}

}  // namespace
}  // namespace hullslam
