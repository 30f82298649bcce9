// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triangulation.h"

#include <gtest/gtest.h>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

Eigen::Vector2d Normalized(const Rigid3& cam_from_world, const Eigen::Vector3d& point) {
  return (cam_from_world * point).hnormalized();
}

TEST(Triangulation, OfTwoCamerasSideBySideMatchesHandComputedValues) {
  // The centres are at x = 0 and x = 1. The rays x/z = 0.5 and 0.25 meet at depth 1 / (0.5 - 0.25)
  // = 4.
  const Rigid3 b_from_world(Eigen::Quaterniond::Identity(), {-1.0, 0.0, 0.0});
  const auto point = TriangulatePoint(Rigid3(), {0.5, -0.25}, b_from_world, {0.25, -0.25});
  ASSERT_TRUE(point.has_value());
  EXPECT_LT((*point - Eigen::Vector3d(2.0, -1.0, 4.0)).norm(), 1e-12);
}

TEST(Triangulation, RecoversThePointThatTwoCamerasSee) {
  RandomGeometry random(1);
  for (int i = 0; i < 200; ++i) {
    const Rigid3 a_from_world = random.Pose(0.3, 1.0);
    const Rigid3 b_from_world = random.Pose(0.3, 1.0);
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 5.0);
    const auto found = TriangulatePoint(a_from_world, Normalized(a_from_world, point), b_from_world,
                                        Normalized(b_from_world, point));
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((*found - point).norm(), 1e-9);
  }
}

TEST(Triangulation, DoesNotDependOnTheOrderOfTheViews) {
  RandomGeometry random(2);
  for (int i = 0; i < 50; ++i) {
    const Rigid3 a_from_world = random.Pose(0.2, 0.5);
    const Rigid3 b_from_world = random.Pose(0.2, 0.5);
    const Eigen::Vector3d point(0.2, -0.1, 4.0);
    // These pixels are off the epipolar line, as real measurements are.
    const Eigen::Vector2d in_a = Normalized(a_from_world, point) + Eigen::Vector2d(1e-3, -1e-3);
    const Eigen::Vector2d in_b = Normalized(b_from_world, point);
    const auto forth = TriangulatePoint(a_from_world, in_a, b_from_world, in_b);
    const auto back = TriangulatePoint(b_from_world, in_b, a_from_world, in_a);
    ASSERT_TRUE(forth.has_value() && back.has_value());
    EXPECT_LT((*forth - *back).norm(), 1e-6 * forth->norm());
  }
}

TEST(Triangulation, ParallelRaysGiveNoPoint) {
  const Rigid3 b_from_world(Eigen::Quaterniond::Identity(), {-1.0, 0.0, 0.0});
  EXPECT_FALSE(TriangulatePoint(Rigid3(), {0.0, 0.0}, b_from_world, {0.0, 0.0}).has_value());
}

// Diverging rays meet behind the cameras; the caller must check this.
TEST(Triangulation, DivergingRaysMeetBehindTheCameras) {
  const Rigid3 b_from_world(Eigen::Quaterniond::Identity(), {-1.0, 0.0, 0.0});
  const auto point = TriangulatePoint(Rigid3(), {-0.25, 0.0}, b_from_world, {0.25, 0.0});
  ASSERT_TRUE(point.has_value());
  EXPECT_NEAR(point->z(), -2.0, 1e-12);
}

}  // namespace
}  // namespace hullslam
