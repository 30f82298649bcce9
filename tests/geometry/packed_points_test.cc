// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/packed_points.h"

#include <gtest/gtest.h>

#include <numbers>

namespace hullslam {
namespace {

TEST(PackedPoints, GivesThePointsBackWithSinglePrecision) {
  const std::vector<Eigen::Vector3d> points = {
      {std::numbers::pi, -1e-3 / 3.0, 640.1}, {0.0, 1.0, -2.5}, {1e6 / 7.0, 0.1, 0.2}};
  const PackedPoints<3> packed(points);
  ASSERT_EQ(packed.size(), 3U);
  const std::vector<Eigen::Vector3d> unpacked = packed.Unpack();
  ASSERT_EQ(unpacked.size(), 3U);
  for (size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(unpacked[i][axis], points[i][axis], 1e-7 * std::abs(points[i][axis]));
    }
  }
  EXPECT_EQ(unpacked[1], points[1]) << "these are exact";
  EXPECT_EQ(PackedPoints<3>(unpacked), packed);
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
