// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/epipolar.h"

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

}  // namespace
}  // namespace hullslam
