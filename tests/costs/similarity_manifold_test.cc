// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/similarity_manifold.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

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
