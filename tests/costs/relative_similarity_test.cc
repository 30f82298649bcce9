// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/relative_similarity.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "costs/manifolds.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;

Sim3 RandomSim3(RandomGeometry& random, double angle) {
  const Rigid3 rigid = random.Pose(angle, 5.0);
  return {std::exp(random.Number(-1.0, 1.0)), rigid.rotation, rigid.translation};
}

Vector7d ResidualOf(const ceres::CostFunction& cost, const Sim3& a, const Sim3& b) {
  const SimilarityBlock block_a = ToBlock(a);
  const SimilarityBlock block_b = ToBlock(b);
  const double* parameters[] = {block_a.data(), block_b.data()};
  Vector7d residual;
  EXPECT_TRUE(cost.Evaluate(parameters, residual.data(), nullptr));
  return residual;
}

// The cost as a function of the steps of the manifold, at zero; see AtPose in cost_laws.h.
class AtSimilarities final : public ceres::SizedCostFunction<7, 7, 7> {
 public:
  AtSimilarities(const ceres::CostFunction& cost, const Sim3& a, const Sim3& b)
      : cost_(cost), blocks_{ToBlock(a), ToBlock(b)} {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    std::array<SimilarityBlock, 2> moved;
    std::array<Eigen::Matrix<double, 7, 8, Eigen::RowMajor>, 2> by_block;
    for (size_t i = 0; i < 2; ++i) {
      SimilarityManifold(false).Plus(blocks_[i].data(), parameters[i], moved[i].data());
    }
    const double* inner[] = {moved[0].data(), moved[1].data()};
    double* inner_jacobians[] = {by_block[0].data(), by_block[1].data()};
    const bool is_defined =
        cost_.Evaluate(inner, residuals, jacobians != nullptr ? inner_jacobians : nullptr);
    for (size_t i = 0; i < 2 && jacobians != nullptr; ++i) {
      EXPECT_TRUE(by_block[i].col(7).isZero(0.0));
      if (jacobians[i] != nullptr) {
        Eigen::Map<Eigen::Matrix<double, 7, 7, Eigen::RowMajor>> by_delta(jacobians[i]);
        by_delta = by_block[i].leftCols<7>();
      }
    }
    return is_defined;
  }

 private:
  const ceres::CostFunction& cost_;
  std::array<SimilarityBlock, 2> blocks_;
};

TEST(RelativeSimilarityCost, ByHand) {
  Vector7d inverse_sigma;
  inverse_sigma << 1.0, 1.0, 10.0, 1.0, 2.0, 3.0, 100.0;
  const Sim3 measured(2.0, Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0});
  const RelativeSimilarityCost cost(measured, inverse_sigma);
  // The frame of b is the world. A point x of the world is 3 R x + (0, 4, 5) in the frame of a,
  // where R turns by a right angle about z. The measurement maps this to 6 R x + (1, 8, 10) in the
  // frame of b. So the error has the rotation R, the translation (1, 8, 10) and the scale 6.
  const Sim3 a_from_world(3.0, ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {0.0, 4.0, 5.0});
  Vector7d expected;
  expected << 0.0, 0.0, 10.0 * std::numbers::pi / 2.0, 1.0, 16.0, 30.0, 100.0 * std::log(6.0);
  EXPECT_LT((ResidualOf(cost, a_from_world, Sim3()) - expected).norm(), 1e-12);
}

TEST(RelativeSimilarityCost, IsZeroIfTheKeyframesAgree) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const Sim3 a = RandomSim3(random, 3.0);
    const Sim3 b = RandomSim3(random, 3.0);
    const RelativeSimilarityCost cost(b * Inverse(a), Vector7d::Ones());
    EXPECT_LT(ResidualOf(cost, a, b).norm(), 1e-12);
  }
}

TEST(RelativeSimilarityCost, DoesNotDependOnTheWorldFrame) {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const RelativeSimilarityCost cost(RandomSim3(random, 1.0), Vector7d::Ones());
    const Sim3 a = RandomSim3(random, 1.0);
    const Sim3 b = RandomSim3(random, 1.0);
    const Sim3 old_from_new = RandomSim3(random, 3.0);
    EXPECT_LT(
        (ResidualOf(cost, a * old_from_new, b * old_from_new) - ResidualOf(cost, a, b)).norm(),
        1e-9);
  }
}

TEST(RelativeSimilarityCost, HasTheTrueGradient) {
  RandomGeometry random(3);
  for (int i = 0; i < 60; ++i) {
    Vector7d inverse_sigma;
    inverse_sigma << random.Vector(2.0), random.Vector(2.0), random.Number(0.5, 2.0);
    const Sim3 a = RandomSim3(random, 2.0);
    const Sim3 b = RandomSim3(random, 2.0);
    // Large errors, small ones, and none.
    const double size = i % 3 == 0 ? 0.8 : (i % 3 == 1 ? 1e-3 : 0.0);
    const Sim3 noise(std::exp(random.Number(-size, size)), ExpSo3(random.Vector(size)),
                     random.Vector(size));
    const RelativeSimilarityCost cost(noise * b * Inverse(a), inverse_sigma);
    const AtSimilarities at_similarities(cost, a, b);
    const ceres::GradientChecker checker(&at_similarities,
                                         static_cast<std::vector<const ceres::Manifold*>*>(nullptr),
                                         ceres::NumericDiffOptions());
    const Vector7d delta = Vector7d::Zero();
    const double* parameters[] = {delta.data(), delta.data()};
    ceres::GradientChecker::ProbeResults results;
    EXPECT_TRUE(checker.Probe(parameters, 1e-6, &results)) << results.error_log;
  }
}

}  // namespace
}  // namespace hullslam
