// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/pose_manifold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

Vector6d RandomDelta(RandomGeometry& random) {
  Vector6d delta;
  delta << random.Vector(1.5), random.Vector(2.0);
  return delta;
}

PoseBlock Plus(const PoseBlock& x, const Vector6d& delta) {
  PoseBlock result;
  EXPECT_TRUE(PoseManifold().Plus(x.data(), delta.data(), result.data()));
  return result;
}

Vector6d Minus(const PoseBlock& y, const PoseBlock& x) {
  Vector6d result;
  EXPECT_TRUE(PoseManifold().Minus(y.data(), x.data(), result.data()));
  return result;
}

// Distance between two poses. It compares matrices, because a quaternion and its negative are the
// same rotation.
double Distance(const PoseBlock& a, const PoseBlock& b) {
  return (FromBlock(a.data()).ToMatrix() - FromBlock(b.data()).ToMatrix()).norm();
}

TEST(PoseBlock, HoldsQuaternionThenTranslation) {
  const double half = std::sqrt(0.5);
  const PoseBlock block =
      ToBlock({ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), Eigen::Vector3d(1.0, 2.0, 3.0)});
  const PoseBlock expected = {0.0, 0.0, half, half, 1.0, 2.0, 3.0};
  for (size_t i = 0; i < block.size(); ++i) {
    EXPECT_NEAR(block[i], expected[i], 1e-15) << i;
  }
}

TEST(PoseBlock, RoundTripKeepsEveryBit) {
  RandomGeometry random(1);
  const Rigid3 pose = random.Pose(1.0, 2.0);
  const Rigid3 back = FromBlock(ToBlock(pose).data());
  EXPECT_EQ(back.rotation.coeffs(), pose.rotation.coeffs());
  EXPECT_EQ(back.translation, pose.translation);
}

TEST(PoseManifold, SizesAreThoseOfThePose) {
  EXPECT_EQ(PoseManifold().AmbientSize(), 7);
  EXPECT_EQ(PoseManifold().TangentSize(), 6);
}

TEST(PoseManifold, PlusIsRetract) {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 pose = random.Pose(1.0, 2.0);
    const Vector6d delta = RandomDelta(random);
    EXPECT_LT(Distance(Plus(ToBlock(pose), delta), ToBlock(Retract(pose, delta))), 1e-14);
  }
}

TEST(PoseManifold, PlusNothingIsTheSame) {
  RandomGeometry random(3);
  const PoseBlock x = ToBlock(random.Pose(1.0, 2.0));
  EXPECT_LT(Distance(Plus(x, Vector6d::Zero()), x), 1e-15);
  EXPECT_LT(Minus(x, x).norm(), 1e-14);
}

TEST(PoseManifold, MinusUndoesPlus) {
  RandomGeometry random(4);
  for (int i = 0; i < 50; ++i) {
    const PoseBlock x = ToBlock(random.Pose(2.0, 2.0));
    const Vector6d delta = RandomDelta(random);
    EXPECT_LT((Minus(Plus(x, delta), x) - delta).norm(), 1e-12);
  }
}

TEST(PoseManifold, PlusUndoesMinus) {
  RandomGeometry random(5);
  for (int i = 0; i < 50; ++i) {
    const PoseBlock x = ToBlock(random.Pose(2.0, 2.0));
    const PoseBlock y = ToBlock(random.Pose(2.0, 2.0));
    EXPECT_LT(Distance(Plus(x, Minus(y, x)), y), 1e-12);
  }
}

TEST(PoseManifold, PlusMayWriteOverItsInput) {
  RandomGeometry random(6);
  const PoseBlock x = ToBlock(random.Pose(1.0, 2.0));
  const Vector6d delta = RandomDelta(random);
  PoseBlock in_place = x;
  ASSERT_TRUE(PoseManifold().Plus(in_place.data(), delta.data(), in_place.data()));
  EXPECT_EQ(in_place, Plus(x, delta));
}

// Costs write their derivative with respect to the tangent into the first six columns, so the
// product with the Jacobian of Plus must give exactly these columns.
TEST(PoseManifold, JacobiansPassTheFirstSixColumns) {
  RandomGeometry random(7);
  const PoseBlock x = ToBlock(random.Pose(1.0, 2.0));
  Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus;
  ASSERT_TRUE(PoseManifold().PlusJacobian(x.data(), plus.data()));
  Eigen::Matrix<double, 6, 7, Eigen::RowMajor> minus;
  ASSERT_TRUE(PoseManifold().MinusJacobian(x.data(), minus.data()));
  Eigen::Matrix<double, 1, 7> gradient;
  gradient << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0;
  EXPECT_EQ(gradient * plus, gradient.leftCols<6>());
  EXPECT_EQ(minus * plus, (Eigen::Matrix<double, 6, 6>::Identity()));
}

}  // namespace
}  // namespace hullslam
