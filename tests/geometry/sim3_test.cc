// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/sim3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

Sim3 RandomSim3(RandomGeometry& random) {
  const Rigid3 rigid = random.Pose(2.0, 5.0);
  return {std::exp(random.Number(-1.0, 1.0)), rigid.rotation, rigid.translation};
}

double Distance(const Sim3& a, const Sim3& b) {
  return std::abs(a.scale - b.scale) +
         (a.rotation.toRotationMatrix() - b.rotation.toRotationMatrix()).norm() +
         (a.translation - b.translation).norm();
}

TEST(Sim3, MovesPointsByHand) {
  // A quarter turn around z takes x to y.
  const Sim3 b_from_a(2.0, ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {10.0, 20.0, 30.0});
  const Eigen::Vector3d moved = b_from_a * Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_LT((moved - Eigen::Vector3d(6.0, 22.0, 36.0)).norm(), 1e-12);
}

TEST(Sim3, DefaultIsIdentity) {
  const Eigen::Vector3d point(1.0, -2.0, 3.0);
  EXPECT_EQ(Sim3() * point, point);
}

TEST(Sim3, InverseByHand) {
  const Sim3 b_from_a(4.0, ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {4.0, 8.0, -12.0});
  const Sim3 a_from_b = Inverse(b_from_a);
  EXPECT_DOUBLE_EQ(a_from_b.scale, 0.25);
  EXPECT_LT((a_from_b.translation - Eigen::Vector3d(-2.0, 1.0, 3.0)).norm(), 1e-12);
}

TEST(Sim3, InverseUndoes) {
  RandomGeometry random(1);
  for (int i = 0; i < 50; ++i) {
    const Sim3 b_from_a = RandomSim3(random);
    const Eigen::Vector3d point = random.Vector(3.0);
    EXPECT_LT((Inverse(b_from_a) * (b_from_a * point) - point).norm(), 1e-12);
    EXPECT_LT(Distance(b_from_a * Inverse(b_from_a), Sim3()), 1e-12);
    EXPECT_LT(Distance(Inverse(b_from_a) * b_from_a, Sim3()), 1e-12);
  }
}

TEST(Sim3, ProductsAreAssociativeAndMovePointsInTurn) {
  RandomGeometry random(2);
  for (int i = 0; i < 50; ++i) {
    const Sim3 d_from_c = RandomSim3(random);
    const Sim3 c_from_b = RandomSim3(random);
    const Sim3 b_from_a = RandomSim3(random);
    const Eigen::Vector3d point = random.Vector(3.0);
    EXPECT_LT(((c_from_b * b_from_a) * point - c_from_b * (b_from_a * point)).norm(), 1e-11);
    EXPECT_LT(Distance((d_from_c * c_from_b) * b_from_a, d_from_c * (c_from_b * b_from_a)), 1e-11);
  }
}

TEST(Sim3, LengthsTakeTheScale) {
  RandomGeometry random(3);
  for (int i = 0; i < 20; ++i) {
    const Sim3 b_from_a = RandomSim3(random);
    const Eigen::Vector3d from = random.Vector(3.0);
    const Eigen::Vector3d to = random.Vector(3.0);
    EXPECT_NEAR((b_from_a * to - b_from_a * from).norm(), b_from_a.scale * (to - from).norm(),
                1e-12);
  }
}

// RGB-D never changes the scale: products and inverses must then have the bits of Rigid3.
TEST(Sim3, AgreesWithRigid3AtScale1) {
  RandomGeometry random(4);
  for (int i = 0; i < 50; ++i) {
    const Rigid3 c_from_b = random.Pose(2.0, 5.0);
    const Rigid3 b_from_a = random.Pose(2.0, 5.0);
    const Eigen::Vector3d point = random.Vector(3.0);
    EXPECT_EQ(Sim3(b_from_a) * point, b_from_a * point);
    const Sim3 product = Sim3(c_from_b) * Sim3(b_from_a);
    EXPECT_EQ(product.scale, 1.0);
    EXPECT_EQ(product.rotation.coeffs(), (c_from_b * b_from_a).rotation.coeffs());
    EXPECT_EQ(product.translation, (c_from_b * b_from_a).translation);
    const Sim3 inverse = Inverse(Sim3(b_from_a));
    EXPECT_EQ(inverse.scale, 1.0);
    EXPECT_EQ(inverse.rotation.coeffs(), Inverse(b_from_a).rotation.coeffs());
    EXPECT_EQ(inverse.translation, Inverse(b_from_a).translation);
  }
}

TEST(Sim3, RetractByHand) {
  const Sim3 b_from_a(3.0, Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0});
  Eigen::Matrix<double, 7, 1> delta;
  delta << 0.0, 0.0, std::numbers::pi / 2.0, 5.0, 6.0, 7.0, std::log(2.0);
  const Sim3 moved = Retract(b_from_a, delta);
  EXPECT_DOUBLE_EQ(moved.scale, 6.0);
  // (1, 1, 0) is at (4, 3, 0) in b, turned to (-3, 4, 0), doubled and moved.
  EXPECT_LT((moved * Eigen::Vector3d(1.0, 1.0, 0.0) - Eigen::Vector3d(-1.0, 14.0, 7.0)).norm(),
            1e-12);
}

TEST(Sim3, RetractHasTheStatedDerivative) {
  RandomGeometry random(6);
  for (int i = 0; i < 20; ++i) {
    const Sim3 b_from_a = RandomSim3(random);
    const Eigen::Vector3d point = random.Vector(3.0);
    const Eigen::Vector3d in_b = b_from_a * point;
    Eigen::Matrix<double, 3, 7> derivative;
    derivative << -Skew(in_b), Eigen::Matrix3d::Identity(), in_b;
    for (int k = 0; k < 7; ++k) {
      const Eigen::Matrix<double, 7, 1> step = 1e-6 * Eigen::Matrix<double, 7, 1>::Unit(k);
      const Eigen::Vector3d slope =
          (Retract(b_from_a, step) * point - Retract(b_from_a, -step) * point) / 2e-6;
      EXPECT_LT((slope - derivative.col(k)).norm(), 1e-8);
    }
  }
}

TEST(Sim3, RetractWithoutScaleIsThatOfRigid3) {
  RandomGeometry random(7);
  const Rigid3 rigid = random.Pose(1.0, 2.0);
  Eigen::Matrix<double, 7, 1> delta;
  delta << random.Vector(0.5), random.Vector(0.5), 0.0;
  const Sim3 moved = Retract(Sim3(rigid), delta);
  const Rigid3 expected = Retract(rigid, Eigen::Matrix<double, 6, 1>(delta.head<6>()));
  EXPECT_EQ(moved.scale, 1.0);
  EXPECT_EQ(moved.rotation.coeffs(), expected.rotation.coeffs());
  EXPECT_EQ(moved.translation, expected.translation);
}

TEST(Sim3, LongProductsKeepUnitRotations) {
  RandomGeometry random(5);
  Sim3 product;
  for (int i = 0; i < 10000; ++i) {
    product = Sim3(random.Pose(2.0, 0.0)) * product;
  }
  EXPECT_NEAR(product.rotation.norm(), 1.0, 1e-14);
}

}  // namespace
}  // namespace hullslam
