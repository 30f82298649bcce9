// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/solid_angle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/polygon.h"

namespace hullslam {
namespace {

const PinholeCamera kCamera{.fx = 200.0, .fy = 210.0, .cx = 320.0, .cy = 240.0};

// The outline of a cone of rays with this half angle about an axis.
std::vector<Eigen::Vector2d> Cone(const Eigen::Vector3d& axis, double half_angle) {
  constexpr int kCorners = 720;
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis);
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < kCorners; ++i) {
    const double t = 2.0 * std::numbers::pi * i / kCorners;
    const Eigen::Vector3d ray(std::sin(half_angle) * std::cos(t),
                              std::sin(half_angle) * std::sin(t), std::cos(half_angle));
    polygon.push_back(kCamera.Project(turn * ray));
  }
  return polygon;
}

TEST(SolidAngle, IsThatOfAConeWhereverItIs) {
  for (const double angle : {0.0, 0.5, 1.0, 1.2}) {
    const Eigen::Vector3d axis(std::sin(angle), 0.0, std::cos(angle));
    EXPECT_NEAR(SolidAngle(kCamera, Cone(axis, 0.15)),
                2.0 * std::numbers::pi * (1.0 - std::cos(0.15)), 1e-5)
        << angle;
  }
  std::vector<Eigen::Vector2d> turned = Cone(Eigen::Vector3d::UnitZ(), 0.15);
  std::reverse(turned.begin(), turned.end());
  EXPECT_LT(SolidAngle(kCamera, turned), 0.0);
}

// Two overlapping cones have the same overlap in the middle of the image and at its rim, which the
// areas of their outlines do not have.
TEST(SolidAngle, TheOverlapDoesNotDependOnThePlaceInTheImage) {
  const auto cones = [](double angle, double other) {
    return std::array{Cone({std::sin(angle), 0.0, std::cos(angle)}, 0.15),
                      Cone({std::sin(other), 0.0, std::cos(other)}, 0.10)};
  };
  const auto middle = cones(0.0, 0.1);
  const auto rim = cones(1.1, 1.2);
  const double expected = OverlapOnSphere(kCamera, middle[0], middle[1]);
  EXPECT_GT(expected, 0.2);
  EXPECT_NEAR(OverlapOnSphere(kCamera, rim[0], rim[1]), expected, 1e-4);
  EXPECT_GT(std::abs(IntersectionOverUnion(rim[0], rim[1]) - expected), 0.02);
  EXPECT_NEAR(OverlapOnSphere(kCamera, rim[1], rim[0]), expected, 1e-4);
}

TEST(SolidAngle, EmptySetsDoNotOverlap) {
  const auto cone = Cone(Eigen::Vector3d::UnitZ(), 0.1);
  EXPECT_NEAR(OverlapOnSphere(kCamera, cone, cone), 1.0, 1e-12);
  EXPECT_EQ(OverlapOnSphere(kCamera, cone, {}), 0.0);
  EXPECT_EQ(OverlapOnSphere(kCamera, {}, cone), 0.0);
  EXPECT_EQ(OverlapOnSphere(kCamera, {}, {}), 0.0);
}

}  // namespace
}  // namespace hullslam
