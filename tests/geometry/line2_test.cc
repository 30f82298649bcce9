// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/line2.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

TEST(Line2, DistanceIsPositiveOnTheSideOfTheNormal) {
  const Line2 line{.normal = {0.6, 0.8}, .offset = -10.0};  // 10 px from the origin
  EXPECT_DOUBLE_EQ(line.SignedDistance({0.0, 0.0}), -10.0);
  EXPECT_DOUBLE_EQ(line.SignedDistance({6.0, 8.0}), 0.0);
  EXPECT_DOUBLE_EQ(line.SignedDistance({9.0, 12.0}), 5.0);
}

TEST(Line2, HomogeneousFormGivesTheDistanceAndIsTheCrossProductOfItsPoints) {
  RandomGeometry random(1);
  for (int i = 0; i < 100; ++i) {
    const double angle = random.Number(-4.0, 4.0);
    const Line2 line{.normal = {std::cos(angle), std::sin(angle)},
                     .offset = random.Number(-300.0, 300.0)};
    const Eigen::Vector2d point(random.Number(0.0, 640.0), random.Number(0.0, 480.0));
    EXPECT_NEAR(line.Homogeneous().dot(point.homogeneous()), line.SignedDistance(point), 1e-10);
    const Eigen::Vector2d foot = point - line.SignedDistance(point) * line.normal;
    const Eigen::Vector2d along(-line.normal.y(), line.normal.x());
    const Eigen::Vector3d joined = foot.homogeneous().cross((foot + along).homogeneous());
    EXPECT_LT(joined.cross(line.Homogeneous()).norm(), 1e-9 * joined.norm());
  }
}

}  // namespace
}  // namespace hullslam
