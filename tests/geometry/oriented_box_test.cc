// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

std::vector<Eigen::Vector3d> Box(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& half) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back(rotation * Eigen::Vector3d(i & 1 ? half.x() : -half.x(),
                                                i & 2 ? half.y() : -half.y(),
                                                i & 4 ? half.z() : -half.z()));
  }
  return points;
}

TEST(OrientedBox, HasTheAxesOfABox) {
  RandomGeometry random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Quaterniond rotation = random.Pose(2.0, 0.0).rotation;
    const auto axes = OrientedBoxAxes(Box(rotation, {0.1, 0.2, 0.4}));
    ASSERT_TRUE(axes);
    EXPECT_NEAR(axes->determinant(), 1.0, 1e-9);
    // Each axis is an axis of the box, up to sign and order.
    const Eigen::Matrix3d cosines = (axes->transpose() * rotation.toRotationMatrix()).cwiseAbs();
    for (int i = 0; i < 3; ++i) {
      EXPECT_GT(cosines.row(i).maxCoeff(), 0.999) << trial;
    }
  }
}

TEST(OrientedBox, IsDeterministic) {
  const auto points = Box(Eigen::Quaterniond(0.9, 0.1, 0.3, 0.2).normalized(), {0.1, 0.2, 0.4});
  EXPECT_EQ(OrientedBoxAxes(points).value(), OrientedBoxAxes(points).value());
}

TEST(OrientedBox, NeedsFourPoints) {
  EXPECT_FALSE(OrientedBoxAxes(std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Zero())));
}

}  // namespace
}  // namespace hullslam
