// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/similarity_optimization.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>

#include "support/made_similarity.h"

namespace hullslam {
namespace {

// A similarity near to that of the matches.
Sim3 Start(MadeSimilarity& made, bool fix_scale) {
  Eigen::Matrix<double, 7, 1> delta;
  delta << made.random().Vector(0.02), made.random().Vector(0.05), 0.0;
  delta[6] = fix_scale ? 0.0 : made.random().Number(-0.1, 0.1);
  return Retract(made.b_from_a(), delta);
}

// Runs a test with free and with fixed scale.
class SimilarityOptimization : public ::testing::TestWithParam<bool> {
 protected:
  SimilarityOptimizationOptions options_{.fix_scale = GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Scale, SimilarityOptimization, ::testing::Bool());

TEST_P(SimilarityOptimization, RecoversTheTrueSimilarity) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    MadeSimilarity made(seed, {.fix_scale = GetParam(), .has_depth = GetParam()});
    const auto matches = made.Make(60);
    const auto result =
        OptimizeSimilarity(made.camera(), Start(made, GetParam()), matches, options_);
    EXPECT_LT(Distance(result.b_from_a, made.b_from_a()), 1e-6);
    EXPECT_EQ(result.inlier_count, 60);
    EXPECT_EQ(result.is_inlier, std::vector<uint8_t>(60, 1));
  }
}

TEST_P(SimilarityOptimization, FlagsThirtyPercentOfOutliers) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    MadeSimilarity made(seed, {.fix_scale = GetParam(), .outliers = 0.3});
    const auto matches = made.Make(100);
    const auto result =
        OptimizeSimilarity(made.camera(), Start(made, GetParam()), matches, options_);
    EXPECT_LT(Distance(result.b_from_a, made.b_from_a()), 1e-6);
    EXPECT_EQ(result.inlier_count, 70);
    EXPECT_EQ(std::accumulate(result.is_inlier.begin() + 30, result.is_inlier.end(), 0), 70);
  }
}

TEST_P(SimilarityOptimization, TheErrorIsAsLargeAsTheNoiseExplains) {
  MadeSimilarity made(3, {.fix_scale = GetParam(), .noise = 1.0});
  const auto matches = made.Make(200);
  const auto result = OptimizeSimilarity(made.camera(), Start(made, GetParam()), matches, options_);
  EXPECT_LT(Distance(result.b_from_a, made.b_from_a()), 0.02);
  EXPECT_GT(Distance(result.b_from_a, made.b_from_a()), 1e-6);
  EXPECT_GT(result.inlier_count, 160);  // 90 % are expected: both images have to agree
}

TEST_P(SimilarityOptimization, TheOtherDirectionGivesTheInverse) {
  MadeSimilarity made(4, {.fix_scale = GetParam(), .outliers = 0.1, .noise = 0.3});
  auto matches = made.Make(100);
  const Sim3 start = Start(made, GetParam());
  const auto there = OptimizeSimilarity(made.camera(), start, matches, options_);
  for (SimilarityMatch& match : matches) {
    std::swap(match.point_in_a, match.point_in_b);
    std::swap(match.measured_in_a, match.measured_in_b);
  }
  const auto back = OptimizeSimilarity(made.camera(), Inverse(start), matches, options_);
  EXPECT_EQ(there.is_inlier, back.is_inlier);
  EXPECT_LT(Distance(there.b_from_a * back.b_from_a, Sim3()), 1e-3);
}

TEST_P(SimilarityOptimization, AFixedScaleKeepsItsBits) {
  MadeSimilarity made(5, {.noise = 0.5});
  const auto matches = made.Make(80);
  const Sim3 start = made.b_from_a();
  const auto result = OptimizeSimilarity(made.camera(), start, matches, options_);
  EXPECT_EQ(result.b_from_a.scale == start.scale, GetParam());
  EXPECT_NE(result.b_from_a.translation, start.translation);
}

TEST_P(SimilarityOptimization, AMatchBehindACameraDoesNotStopTheOthers) {
  MadeSimilarity made(6, {.fix_scale = GetParam()});
  auto matches = made.Make(50);
  matches[3].point_in_a.z() = -2.0;
  matches[7].point_in_b.z() = -2.0;
  matches[9] = made.MakeMatch({0.0, 0.0, -3.0});
  const auto result = OptimizeSimilarity(made.camera(), Start(made, GetParam()), matches, options_);
  EXPECT_LT(Distance(result.b_from_a, made.b_from_a()), 1e-6);
  EXPECT_EQ(result.inlier_count, 47);
  EXPECT_EQ(result.is_inlier[3] + result.is_inlier[7] + result.is_inlier[9], 0);
}

TEST_P(SimilarityOptimization, ReturnsTheStartForFewerThanThreeMatches) {
  MadeSimilarity made(7, {.fix_scale = GetParam()});
  const Sim3 start = Start(made, GetParam());
  for (const size_t count : {0u, 1u, 2u}) {
    const auto result = OptimizeSimilarity(made.camera(), start, made.Make(count), options_);
    EXPECT_EQ(Distance(result.b_from_a, start), 0.0);
    EXPECT_LT(result.inlier_count, 3);
  }
  // The start is also returned if only wrong matches are left.
  MadeSimilarity wrong(8, {.fix_scale = GetParam(), .outliers = 1.0});
  const auto result = OptimizeSimilarity(wrong.camera(), start, wrong.Make(6), options_);
  ASSERT_LT(result.inlier_count, 3);
  EXPECT_EQ(Distance(result.b_from_a, start), 0.0);
}

TEST_P(SimilarityOptimization, SameInputGivesTheSameBits) {
  MadeSimilarity made(9, {.fix_scale = GetParam(), .outliers = 0.2, .noise = 0.5});
  const auto matches = made.Make(100);
  const Sim3 start = Start(made, GetParam());
  const Sim3 first = OptimizeSimilarity(made.camera(), start, matches, options_).b_from_a;
  const Sim3 second = OptimizeSimilarity(made.camera(), start, matches, options_).b_from_a;
  EXPECT_EQ(first.rotation.coeffs(), second.rotation.coeffs());
  EXPECT_EQ(first.translation, second.translation);
  EXPECT_EQ(first.scale, second.scale);
}

// If both cameras are at one position, all scales have the same reprojection errors.
TEST(SimilarityOptimizationOfOnePlace, TheDepthsGiveTheScale) {
  MadeSimilarity made(10, {.noise = 0.3});
  std::vector<SimilarityMatch> matches;
  for (int i = 0; i < 60; ++i) {
    SimilarityMatch match = made.MakeMatch(made.RandomPoint());
    match.point_in_b = made.random().Number(1.35, 1.65) * match.point_in_a;
    match.measured_in_b = match.measured_in_a;
    matches.push_back(match);
  }
  const Sim3 start(1.3, ExpSo3({0.01, 0.0, 0.01}), {0.03, 0.0, 0.02});
  const auto result = OptimizeSimilarity(made.camera(), start, matches);
  EXPECT_NEAR(result.b_from_a.scale, 1.5, 0.05);
  EXPECT_GE(result.inlier_count, 55);
}

}  // namespace
}  // namespace hullslam
