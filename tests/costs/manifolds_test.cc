// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/manifolds.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
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

using Vector7d = Eigen::Matrix<double, 7, 1>;

Sim3 RandomSim3(RandomGeometry& random) {
  const Rigid3 rigid = random.Pose(2.0, 5.0);
  return {std::exp(random.Number(-1.0, 1.0)), rigid.rotation, rigid.translation};
}

TEST(SimilarityManifold, ABlockKeepsTheSimilarity) {
  RandomGeometry random(1);
  const Sim3 similarity = RandomSim3(random);
  const SimilarityBlock block = ToBlock(similarity);
  EXPECT_EQ(block[3], similarity.rotation.w());
  EXPECT_EQ(block[4], similarity.translation.x());
  EXPECT_EQ(block[7], similarity.scale);
  const Sim3 back = SimilarityFromBlock(block.data());
  EXPECT_EQ(back.scale, similarity.scale);
  EXPECT_EQ(back.rotation.coeffs(), similarity.rotation.coeffs());
  EXPECT_EQ(back.translation, similarity.translation);
}

TEST(SimilarityManifold, PlusIsRetractAndMinusUndoesIt) {
  RandomGeometry random(2);
  const SimilarityManifold manifold(false);
  ASSERT_EQ(manifold.TangentSize(), 7);
  for (int i = 0; i < 50; ++i) {
    const Sim3 start = RandomSim3(random);
    Vector7d delta;
    delta << random.Vector(1.0), random.Vector(1.0), random.Number(-1.0, 1.0);
    const SimilarityBlock block = ToBlock(start);
    SimilarityBlock moved;
    ASSERT_TRUE(manifold.Plus(block.data(), delta.data(), moved.data()));
    EXPECT_EQ(moved, ToBlock(Retract(start, delta)));
    Vector7d back;
    ASSERT_TRUE(manifold.Minus(moved.data(), block.data(), back.data()));
    EXPECT_LT((back - delta).norm(), 1e-12);
  }
}

TEST(SimilarityManifold, AFixedScaleDoesNotChange) {
  RandomGeometry random(3);
  const SimilarityManifold manifold(true);
  ASSERT_EQ(manifold.TangentSize(), 6);
  for (int i = 0; i < 50; ++i) {
    const Sim3 start = RandomSim3(random);
    Eigen::Matrix<double, 6, 1> delta;
    delta << random.Vector(1.0), random.Vector(1.0);
    const SimilarityBlock block = ToBlock(start);
    SimilarityBlock moved;
    ASSERT_TRUE(manifold.Plus(block.data(), delta.data(), moved.data()));
    EXPECT_EQ(moved[7], start.scale);
    Eigen::Matrix<double, 6, 1> back;
    ASSERT_TRUE(manifold.Minus(moved.data(), block.data(), back.data()));
    EXPECT_LT((back - delta).norm(), 1e-12);
  }
}

TEST(SimilarityManifold, TheJacobiansSelectTheFirstColumns) {
  for (const bool fix_scale : {false, true}) {
    const SimilarityManifold manifold(fix_scale);
    const SimilarityBlock block = ToBlock(Sim3());
    const Eigen::Index size = manifold.TangentSize();
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> plus(8, size);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> minus(size, 8);
    ASSERT_TRUE(manifold.PlusJacobian(block.data(), plus.data()));
    ASSERT_TRUE(manifold.MinusJacobian(block.data(), minus.data()));
    EXPECT_EQ(plus, Eigen::MatrixXd::Identity(8, size));
    EXPECT_EQ(minus, Eigen::MatrixXd::Identity(size, 8));
  }
}

}  // namespace

}  // namespace hullslam
