// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/similarity_error.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "support/made_similarity.h"

namespace hullslam {
namespace {

const MadeSimilarityOptions kWithDepthAndNoise{.has_depth = true, .noise = 2.0};

TEST(SimilarityError, ByHand) {
  const PinholeCamera camera{.fx = 100.0, .fy = 100.0, .cx = 50.0, .cy = 50.0};
  const TwoWaySimilarity b_from_a(
      Sim3(2.0, Eigen::Quaterniond::Identity(), Eigen::Vector3d(1.0, 0.0, 0.0)));
  SimilarityMatch match;
  match.point_in_a = {0.0, 0.0, 1.0};  // at (1, 0, 2) in b: pixel (100, 50)
  match.point_in_b = {3.0, 2.0, 4.0};  // at (1, 1, 2) in a: pixel (100, 100)
  match.measured_in_a.measured = {101.0, 102.0, 0.0};
  match.measured_in_b.measured = {96.0, 50.0, 0.0};
  match.measured_in_b.inverse_sigma = {0.5, 0.5, 0.0};
  const SimilarityChi2 chi2(camera, match, b_from_a);
  EXPECT_NEAR(chi2.in_a, 5.0, 1e-12);
  EXPECT_NEAR(chi2.in_b, 4.0, 1e-12);
  EXPECT_NEAR(SimilarityError(camera, match, b_from_a), 5.0 / 5.991, 1e-12);
  match.measured_in_b.measured.x() = 90.0;
  EXPECT_NEAR(SimilarityError(camera, match, b_from_a), 25.0 / 5.991, 1e-12);
}

TEST(SimilarityError, IsInfiniteBehindOneOfTheCameras) {
  MadeSimilarity made(1, {});
  const TwoWaySimilarity truth(made.b_from_a());
  SimilarityMatch match = made.MakeMatch(made.RandomPoint());
  EXPECT_LT(SimilarityError(made.camera(), match, truth), 1e-12);
  SimilarityMatch behind = match;
  behind.point_in_a.z() = -10.0;
  EXPECT_EQ(SimilarityError(made.camera(), behind, truth), std::numeric_limits<double>::infinity());
  behind = match;
  behind.point_in_b.z() = -10.0;
  EXPECT_EQ(SimilarityError(made.camera(), behind, truth), std::numeric_limits<double>::infinity());
}

TEST(SimilarityError, IsSymmetric) {
  MadeSimilarity made(2, kWithDepthAndNoise);
  for (const SimilarityMatch& match : made.Make(50)) {
    SimilarityMatch swapped = match;
    std::swap(swapped.point_in_a, swapped.point_in_b);
    std::swap(swapped.measured_in_a, swapped.measured_in_b);
    EXPECT_NEAR(SimilarityError(made.camera(), match, TwoWaySimilarity(made.b_from_a())),
                SimilarityError(made.camera(), swapped, TwoWaySimilarity(Inverse(made.b_from_a()))),
                1e-9);
  }
}

TEST(SimilarityResidual, SquaredNormIsTheError) {
  MadeSimilarity made(3, kWithDepthAndNoise);
  const TwoWaySimilarity truth(made.b_from_a());
  for (const SimilarityMatch& match : made.Make(50)) {
    const SimilarityChi2 chi2(made.camera(), match, truth);
    EXPECT_NEAR(SimilarityResidualInA(made.camera(), match, truth).residual.squaredNorm(),
                chi2.in_a, 1e-9);
    EXPECT_NEAR(SimilarityResidualInB(made.camera(), match, truth).residual.squaredNorm(),
                chi2.in_b, 1e-9);
  }
}

TEST(SimilarityResidual, TheJacobianIsTheDerivative) {
  MadeSimilarity made(4, kWithDepthAndNoise);
  for (const SimilarityMatch& match : made.Make(20)) {
    const TwoWaySimilarity at(made.b_from_a());
    for (const auto residual_in : {SimilarityResidualInA, SimilarityResidualInB}) {
      const SimilarityResidual residual = residual_in(made.camera(), match, at);
      for (int k = 0; k < 7; ++k) {
        const auto moved = [&](double step) {
          const Sim3 b_from_a =
              Retract(made.b_from_a(), step * Eigen::Matrix<double, 7, 1>::Unit(k));
          return residual_in(made.camera(), match, TwoWaySimilarity(b_from_a)).residual;
        };
        const Eigen::Vector3d slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
        EXPECT_LT((slope - residual.jacobian.col(k)).norm(), 1e-5 * (1.0 + slope.norm()));
      }
    }
  }
}

TEST(SimilarityDepthResidual, ByHand) {
  SimilarityMatch match;
  match.point_in_a = {0.5, 0.2, 1.0};
  match.point_in_b = {1.0, 0.5, 3.0};
  const TwoWaySimilarity b_from_a(Sim3(2.0, Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}));
  EXPECT_NEAR(SimilarityDepthResidual(match, b_from_a).residual, 5.0 * std::log(4.0 / 3.0), 1e-12);
}

TEST(SimilarityDepthResidual, TheJacobianIsTheDerivative) {
  MadeSimilarity made(5, kWithDepthAndNoise);
  for (const SimilarityMatch& match : made.Make(20)) {
    const SimilarityDepthResidual residual(match, TwoWaySimilarity(made.b_from_a()));
    for (int k = 0; k < 7; ++k) {
      const auto moved = [&](double step) {
        const Sim3 b_from_a = Retract(made.b_from_a(), step * Eigen::Matrix<double, 7, 1>::Unit(k));
        return SimilarityDepthResidual(match, TwoWaySimilarity(b_from_a)).residual;
      };
      EXPECT_NEAR((moved(1e-6) - moved(-1e-6)) / 2e-6, residual.jacobian[k], 1e-6);
    }
  }
}

}  // namespace
}  // namespace hullslam
