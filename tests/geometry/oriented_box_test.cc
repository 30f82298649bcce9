// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
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

// The volume of the box along the axes.
double Volume(const std::vector<Eigen::Vector3d>& points, const Eigen::Matrix3d& axes) {
  Eigen::Vector3d low = axes.transpose() * points[0];
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& point : points) {
    low = low.cwiseMin(axes.transpose() * point);
    high = high.cwiseMax(axes.transpose() * point);
  }
  return (high - low).prod();
}

// Points on the visible sides of a box with noise, as a depth image gives them.
TEST(OrientedBox, IsHardlyLargerThanTheTrueBox) {
  RandomGeometry random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Matrix3d rotation = random.Pose(2.0, 0.0).rotation.toRotationMatrix();
    const Eigen::Vector3d half(0.1, 0.2, 0.4);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 500; ++i) {
      Eigen::Vector3d point = random.Vector(1.0).cwiseProduct(half);
      point[i % 3] = half[i % 3];
      points.push_back(rotation * (point + random.Vector(0.003)));
    }
    const auto axes = OrientedBoxAxes(points);
    ASSERT_TRUE(axes);
    EXPECT_LT(Volume(points, *axes), 1.05 * Volume(points, rotation)) << trial;
  }
}

TEST(OrientedBox, OfPointsInAPlaneHasAnAxisAcrossIt) {
  const std::vector<Eigen::Vector3d> points = {
      {0.0, 0.0, 1.0}, {2.0, 0.0, 1.0}, {2.0, 1.0, 1.0}, {0.0, 1.0, 1.0}, {1.0, 0.5, 1.0}};
  const auto axes = OrientedBoxAxes(points);
  ASSERT_TRUE(axes);
  EXPECT_NEAR(axes->row(2).cwiseAbs().maxCoeff(), 1.0, 1e-9);
}

TEST(OrientedBox, OfPointsOnALineIsUnknown) {
  const std::vector<Eigen::Vector3d> points = {
      {0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {2.0, 0.0, 1.0}, {3.0, 0.0, 1.0}};
  EXPECT_FALSE(OrientedBoxAxes(points));
}

// The result depends neither on the order of the points nor on the addresses of memory in CGAL.
TEST(OrientedBox, DependsOnThePointsAlone) {
  RandomGeometry random(3);
  std::mt19937 generator(3);
  std::vector<std::vector<char>> blocks;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 200; ++i) {
      points.push_back(random.Vector(1.0));
    }
    const Eigen::Matrix3d axes = OrientedBoxAxes(points).value();
    for (int again = 0; again < 5; ++again) {
      blocks.emplace_back(static_cast<size_t>(random.Number(1, 100000)));
      std::shuffle(points.begin(), points.end(), generator);
      EXPECT_EQ(OrientedBoxAxes(points).value(), axes) << trial;
    }
  }
}

// Up to rounding errors the points are on a line.
TEST(OrientedBox, OfPointsThatAreNearlyOnALineIsUnknownOrFinite) {
  RandomGeometry random(8);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d ends[] = {random.Vector(0.3), random.Vector(0.3)};
    std::vector<Eigen::Vector3d> points;
    for (int view = 0; view < 4; ++view) {
      const Rigid3 pose = random.Pose(1.0, 2.0);
      for (const Eigen::Vector3d& end : ends) {
        points.push_back(Inverse(pose) * (pose * end));
      }
    }
    const std::optional<Eigen::Matrix3d> axes = OrientedBoxAxes(points);
    EXPECT_TRUE(!axes || axes->allFinite());
  }
}

TEST(OrientedBox, NeedsFourPoints) {
  EXPECT_FALSE(OrientedBoxAxes(std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Zero())));
}

}  // namespace
}  // namespace hullslam
