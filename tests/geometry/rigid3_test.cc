// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/rigid3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/pose_distance.h"

namespace hullslam {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

class Random {
 public:
  double Number() { return distribution_(generator_); }
  Eigen::Vector3d Vector() { return {Number(), Number(), Number()}; }
  Rigid3 Pose() { return {ExpSo3(2.0 * Vector()), 5.0 * Vector()}; }

 private:
  std::mt19937 generator_{3};
  std::uniform_real_distribution<double> distribution_{-1.0, 1.0};
};

TEST(Rigid3, MovesPointsAsComputedByHand) {
  // A quarter turn around z takes x to y.
  const Rigid3 b_from_a(ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {10.0, 20.0, 30.0});
  const Eigen::Vector3d moved = b_from_a * Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_LT((moved - Eigen::Vector3d(8.0, 21.0, 33.0)).norm(), 1e-12);
}

TEST(Rigid3, DefaultIsIdentity) {
  const Eigen::Vector3d point(1.0, -2.0, 3.0);
  EXPECT_EQ(Rigid3() * point, point);
}

TEST(Rigid3, ToMatrixMovesPointsInTheSameWay) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Rigid3 pose = random.Pose();
    const Eigen::Vector3d point = random.Vector();
    EXPECT_LT((pose.ToMatrix() * point.homogeneous() - pose * point).norm(), 1e-12);
  }
}

TEST(Rigid3, ProductsAreAssociativeAndMovePointsInTurn) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Rigid3 d_from_c = random.Pose();
    const Rigid3 c_from_b = random.Pose();
    const Rigid3 b_from_a = random.Pose();
    const Eigen::Vector3d point = random.Vector();
    EXPECT_LT(((c_from_b * b_from_a) * point - c_from_b * (b_from_a * point)).norm(), 1e-12);
    EXPECT_LT(Distance((d_from_c * c_from_b) * b_from_a, d_from_c * (c_from_b * b_from_a)), 1e-12);
  }
}

TEST(Rigid3, InverseUndoesTheTransform) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Rigid3 pose = random.Pose();
    EXPECT_LT(Distance(pose * Inverse(pose), Rigid3()), 1e-12);
    EXPECT_LT(Distance(Inverse(pose) * pose, Rigid3()), 1e-12);
  }
}

TEST(Rigid3, LongProductsKeepUnitRotations) {
  Random random;
  Rigid3 pose;
  for (int i = 0; i < 10000; ++i) {
    pose = random.Pose() * pose;
    pose.translation.setZero();
  }
  EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-14);
}

TEST(So3, ExpTurnsAroundItsAxis) {
  Random random;
  for (const double angle : {1e-12, 1e-6, 9e-5, 1.1e-4, 0.3, 3.0, 6.0}) {
    const Eigen::Vector3d axis = random.Vector().normalized();
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((ExpSo3(angle * axis).toRotationMatrix() - expected).norm(), 1e-14) << angle;
  }
  EXPECT_EQ(ExpSo3(Eigen::Vector3d::Zero()).w(), 1.0);
}

TEST(So3, LogInvertsExp) {
  Random random;
  for (const double angle : {0.0, 1e-11, 1e-7, 1e-4, 0.5, 2.0, 3.14, std::numbers::pi - 1e-9}) {
    const Eigen::Vector3d omega = angle * random.Vector().normalized();
    EXPECT_LT((LogSo3(ExpSo3(omega)) - omega).norm(), 1e-14 + 1e-9 * angle) << angle;
  }
}

// Both signs of a quaternion describe the same rotation.
TEST(So3, LogIsTheShortestRotation) {
  const Eigen::Vector3d omega(0.0, 0.0, 1.5 * std::numbers::pi);
  EXPECT_LT((LogSo3(ExpSo3(omega)) - Eigen::Vector3d(0.0, 0.0, -0.5 * std::numbers::pi)).norm(),
            1e-12);
  Eigen::Quaterniond rotation = ExpSo3({0.1, 0.2, -0.3});
  const Eigen::Vector3d log = LogSo3(rotation);
  rotation.coeffs() = -rotation.coeffs();
  EXPECT_EQ(LogSo3(rotation), log);
}

TEST(So3, SkewIsTheCrossProduct) {
  Random random;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d a = random.Vector();
    const Eigen::Vector3d b = random.Vector();
    EXPECT_LT((Skew(a) * b - a.cross(b)).norm(), 1e-15);
    EXPECT_EQ(Skew(a), -Skew(a).transpose());
  }
}

TEST(Retract, ActsOnTheLeft) {
  Random random;
  const Rigid3 pose = random.Pose();
  const Eigen::Vector3d point = random.Vector();
  Vector6d delta;
  delta << 0.0, 0.0, std::numbers::pi / 2.0, 1.0, 2.0, 3.0;
  const Eigen::Vector3d before = pose * point;
  const Eigen::Vector3d expected(-before.y() + 1.0, before.x() + 2.0, before.z() + 3.0);
  EXPECT_LT((Retract(pose, delta) * point - expected).norm(), 1e-12);
  EXPECT_LT(Distance(Retract(pose, Vector6d::Zero()), pose), 1e-14);
}

TEST(Retract, DerivativeAtZeroMatchesItsDocumentation) {
  Random random;
  const Rigid3 pose = random.Pose();
  const Eigen::Vector3d point = random.Vector();
  Eigen::Matrix<double, 3, 6> expected;
  expected << -Skew(pose * point), Eigen::Matrix3d::Identity();
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d delta = kStep * Vector6d::Unit(i);
    const Eigen::Vector3d slope =
        (Retract(pose, delta) * point - Retract(pose, -delta) * point) / (2.0 * kStep);
    EXPECT_LT((slope - expected.col(i)).norm(), 1e-8) << i;
  }
}

TEST(AngularDistance, IsTheAngleBetween) {
  Random random;
  for (const double angle : {0.0, 1e-6, 0.7, 3.1}) {
    const Eigen::Quaterniond a = ExpSo3(random.Vector());
    const Eigen::Quaterniond b = a * ExpSo3(angle * random.Vector().normalized());
    EXPECT_NEAR(AngularDistance(a, b), angle, 1e-9);
    EXPECT_NEAR(AngularDistance(b, a), angle, 1e-9);
  }
}

TEST(Rigid3, PartsOfAMotionAddUp) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Rigid3 motion(ExpSo3(1.5 * random.Vector()), random.Vector());
    const double a = 2.0 * random.Number();
    const double b = 2.0 * random.Number();
    EXPECT_LT(Distance(PartOfMotion(motion, 1.0), motion), 1e-12);
    EXPECT_LT(Distance(PartOfMotion(motion, 0.0), Rigid3()), 1e-12);
    EXPECT_LT(
        Distance(PartOfMotion(motion, a) * PartOfMotion(motion, b), PartOfMotion(motion, a + b)),
        1e-12);
  }
}

TEST(Rigid3, PartOfAMotionAsComputedByHand) {
  const Rigid3 shift(Eigen::Quaterniond::Identity(), {1.0, -2.0, 3.0});
  EXPECT_LT(Distance(PartOfMotion(shift, 0.5),
                     {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.5, -1.0, 1.5)}),
            1e-15);
  // Half a turn around (0, 1, 0) by quarters: the origin moves on a circle around that point.
  const Rigid3 quarter(ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {1.0, 1.0, 0.0});
  EXPECT_LT(Distance(PartOfMotion(quarter, 2.0),
                     {ExpSo3({0.0, 0.0, std::numbers::pi}), Eigen::Vector3d(0.0, 2.0, 0.0)}),
            1e-12);
  const Rigid3 small(ExpSo3({0.0, 0.0, 2e-5}), {1.0, 0.0, 0.0});
  EXPECT_LT(Distance(PartOfMotion(small, 3.0), small * small * small), 1e-13);
}

TEST(Rigid3, DifferenceUndoesRetract) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Rigid3 pose(ExpSo3(random.Vector()), random.Vector());
    Eigen::Matrix<double, 6, 1> delta;
    delta << random.Vector(), random.Vector();
    EXPECT_LT((Difference(pose, Retract(pose, delta)) - delta).norm(), 1e-12);
  }
}

TEST(Rigid3, AdjointMovesASmallMotionToOtherAxes) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Rigid3 a_from_world(ExpSo3(random.Vector()), random.Vector());
    const Rigid3 b_from_a(ExpSo3(random.Vector()), random.Vector());
    Eigen::Matrix<double, 6, 1> delta;
    delta << random.Vector(), random.Vector();
    delta *= 1e-6;
    const Rigid3 moved = b_from_a * Retract(a_from_world, delta);
    EXPECT_LT(Distance(moved, Retract(b_from_a * a_from_world, Adjoint(b_from_a) * delta)), 1e-10);
    const Eigen::Matrix<double, 6, 6> covariance = delta * delta.transpose();
    const Eigen::Matrix<double, 6, 1> there = Adjoint(b_from_a) * delta;
    EXPECT_TRUE(InAxesOf(b_from_a, covariance).isApprox(there * there.transpose(), 1e-9));
  }
}

}  // namespace
}  // namespace hullslam
