// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

Eigen::Matrix3d Calibration(double fx, double fy, double cx, double cy) {
  Eigen::Matrix3d k;
  k << fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0;
  return k;
}

// Two cameras side by side: epipolar lines are the image rows.
TEST(Epipolar, OfAMotionAlongXMatchesHandComputedValues) {
  const Rigid3 b_from_a(Eigen::Quaterniond::Identity(), {-2.0, 0.0, 0.0});
  Eigen::Matrix3d expected;
  expected << 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, -2.0, 0.0;
  EXPECT_EQ(EssentialFromPose(b_from_a), expected);

  const Eigen::Matrix3d k = Calibration(500.0, 400.0, 320.0, 240.0);
  const Eigen::Vector3d line =
      FundamentalFromPose(b_from_a, k, k) * Eigen::Vector3d(100.0, 77.0, 1.0);
  EXPECT_NEAR(line.x(), 0.0, 1e-15);
  EXPECT_NEAR(-line.z() / line.y(), 77.0, 1e-10);
}

TEST(Epipolar, ProjectionsOfOnePointSatisfyTheConstraint) {
  RandomGeometry random(1);
  const Eigen::Matrix3d k_a = Calibration(500.0, 510.0, 320.0, 240.0);
  const Eigen::Matrix3d k_b = Calibration(450.0, 440.0, 300.0, 250.0);
  for (int i = 0; i < 100; ++i) {
    const Rigid3 b_from_a = random.Pose(0.3, 1.0);
    const Eigen::Vector3d in_a = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 4.0);
    const Eigen::Vector3d in_b = b_from_a * in_a;
    const Eigen::Vector3d normalized_a = in_a / in_a.z();
    const Eigen::Vector3d normalized_b = in_b / in_b.z();
    EXPECT_NEAR(normalized_b.dot(EssentialFromPose(b_from_a) * normalized_a), 0.0, 1e-14);

    const Eigen::Vector3d line = FundamentalFromPose(b_from_a, k_a, k_b) * (k_a * normalized_a);
    const double distance = (k_b * normalized_b).dot(line) / line.head<2>().norm();
    EXPECT_NEAR(distance, 0.0, 1e-9);
  }
}

TEST(Epipolar, ConstraintIsViolatedByAPointOffTheLine) {
  const Rigid3 b_from_a(ExpSo3({0.1, -0.2, 0.05}), {0.3, -0.1, 0.2});
  const Eigen::Vector3d in_a(0.4, 0.3, 3.0);
  const Eigen::Vector3d in_b = b_from_a * in_a;
  const Eigen::Vector3d line = EssentialFromPose(b_from_a) * (in_a / in_a.z());
  const Eigen::Vector2d normal = line.head<2>().normalized();
  const Eigen::Vector2d moved = in_b.hnormalized() + 0.01 * normal;
  EXPECT_NEAR(moved.homogeneous().dot(line) / line.head<2>().norm(), 0.01, 1e-12);
}

TEST(Epipolar, EssentialHasTwoEqualSingularValuesAndTheEpipolesAsNullVectors) {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 b_from_a = random.Pose(1.0, 2.0);
    const Eigen::Matrix3d essential = EssentialFromPose(b_from_a);
    const Eigen::Vector3d singular = Eigen::JacobiSVD<Eigen::Matrix3d>(essential).singularValues();
    EXPECT_NEAR(singular[0], b_from_a.translation.norm(), 1e-12);
    EXPECT_NEAR(singular[1], singular[0], 1e-12);
    EXPECT_NEAR(singular[2], 0.0, 1e-12);
    // The centre of camera a seen from b, and the centre of b seen from a.
    EXPECT_LT((b_from_a.translation.transpose() * essential).norm(), 1e-12);
    EXPECT_LT((essential * Inverse(b_from_a).translation).norm(), 1e-12);
  }
}

TEST(Epipolar, SwappingTheCamerasTransposesTheMatrix) {
  RandomGeometry random(3);
  const Eigen::Matrix3d k_a = Calibration(500.0, 510.0, 320.0, 240.0);
  const Eigen::Matrix3d k_b = Calibration(450.0, 440.0, 300.0, 250.0);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 b_from_a = random.Pose(1.0, 2.0);
    const Eigen::Matrix3d forth = FundamentalFromPose(b_from_a, k_a, k_b);
    const Eigen::Matrix3d back = FundamentalFromPose(Inverse(b_from_a), k_b, k_a);
    const double scale = forth.norm();
    const double same = (forth - back.transpose()).norm();
    const double opposite = (forth + back.transpose()).norm();
    EXPECT_LT(std::min(same, opposite), 1e-12 * scale);
  }
}

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
