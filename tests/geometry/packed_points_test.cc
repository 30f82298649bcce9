// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/packed_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace hullslam {
namespace {

TEST(PackedPoints, RoundsCoordinatesToA65535thOfTheirExtent) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 200; ++i) {
    points.emplace_back(639.0 * std::abs(std::sin(i)), -3.0 + 0.1 * std::cos(3.0 * i),
                        1e3 + 1e-3 * i);
  }
  const Eigen::Vector3d extent(639.0, 0.2, 0.2);
  const PackedPoints<3> packed(points);
  ASSERT_EQ(packed.size(), points.size());
  const std::vector<Eigen::Vector3d> unpacked = packed.Unpack();
  ASSERT_EQ(unpacked.size(), points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double rounding = 1.2e-7 * std::abs(points[i][axis]);
      EXPECT_NEAR(unpacked[i][axis], points[i][axis], extent[axis] / 131070.0 + rounding);
    }
  }
}

TEST(PackedPoints, EqualCoordinatesAreKeptInSinglePrecision) {
  const std::vector<Eigen::Vector2d> points = {{std::numbers::pi, 1.0}, {std::numbers::pi, 3.0}};
  const std::vector<Eigen::Vector2d> unpacked = PackedPoints<2>(points).Unpack();
  EXPECT_EQ(unpacked[0].x(), static_cast<double>(static_cast<float>(std::numbers::pi)));
  EXPECT_EQ(unpacked[1].x(), unpacked[0].x());
  EXPECT_EQ(unpacked[0].y(), 1.0);
  EXPECT_NEAR(unpacked[1].y(), 3.0, 1e-6);
  const std::vector<Eigen::Vector2d> one = {{-7.5, 1e5}};
  EXPECT_EQ(PackedPoints<2>(one).Unpack(), one);
}

TEST(PackedPoints, EqualPointsArePackedEqually) {
  const std::vector<Eigen::Vector2d> points = {{1.0, 2.0}, {4.0, 5.5}, {2.0, 9.0}};
  EXPECT_EQ(PackedPoints<2>(points), PackedPoints<2>(points));
  std::vector<Eigen::Vector2d> moved = points;
  moved[1].x() -= 0.01;
  EXPECT_NE(PackedPoints<2>(points), PackedPoints<2>(moved));
}

TEST(PackedPoints, IsEmptyAtFirstAndAfterClear) {
  PackedPoints<2> packed;
  EXPECT_TRUE(packed.empty());
  EXPECT_TRUE(packed.Unpack().empty());
  packed = std::vector<Eigen::Vector2d>{{1.0, 2.0}};
  EXPECT_FALSE(packed.empty());
  EXPECT_NE(packed, PackedPoints<2>());
  packed.clear();
  EXPECT_TRUE(packed.empty());
  EXPECT_EQ(packed.size(), 0U);
}

}  // namespace
}  // namespace hullslam
