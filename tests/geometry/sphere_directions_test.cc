// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/sphere_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hullslam {
namespace {

TEST(SphereDirection, EachHasItsShareOfTheSphere) {
  constexpr int kCount = 256;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d direction = SphereDirection(i, kCount);
    EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
    EXPECT_EQ(direction.z() > 0.0, i < kCount / 2);
    spread += 3.0 / kCount * direction * direction.transpose();
    double nearest = -1.0;
    for (int k = 0; k < kCount; ++k) {
      nearest = k == i ? nearest : std::max(nearest, direction.dot(SphereDirection(k, kCount)));
    }
    // A direction's share of the sphere is a disc of 7.2 degrees; neighbours are 9 to 16 apart.
    EXPECT_LT(nearest, std::cos(0.15)) << i;
    EXPECT_GT(nearest, std::cos(0.28)) << i;
  }
  EXPECT_TRUE(spread.isApprox(Eigen::Matrix3d::Identity(), 0.01)) << spread;
}

}  // namespace
}  // namespace hullslam
