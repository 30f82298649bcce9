// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/similarity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/made_similarity.h"

namespace hullslam {
namespace {

SimilarityOptions Options(bool fix_scale, uint64_t seed = 0) {
  SimilarityOptions options;
  options.fix_scale = fix_scale;
  options.ransac.seed = seed;
  return options;
}

// Runs a test with free and with fixed scale.
class SimilarityEstimate : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Scale, SimilarityEstimate, ::testing::Bool());

TEST_P(SimilarityEstimate, ExactMatchesGiveTheExactSimilarity) {
  for (const bool has_depth : {false, true}) {
    for (uint32_t seed = 0; seed < 50; ++seed) {
      // With another unit of length the depth would not agree.
      if (has_depth && !GetParam()) {
        continue;
      }
      MadeSimilarity made(seed, {.fix_scale = GetParam(), .has_depth = has_depth});
      const auto matches = made.Make(20);
      const Similarity result =
          EstimateSimilarity(made.camera(), matches, Options(GetParam(), seed));
      ASSERT_TRUE(result.ok()) << result.failure;
      EXPECT_LT(Distance(result.b_from_a, made.b_from_a()), 1e-9);
      EXPECT_EQ(result.inliers.size(), 20u);
      EXPECT_NEAR(result.score, 20.0, 1e-9);
      EXPECT_LE(result.iterations, 2);
    }
  }
}

TEST_P(SimilarityEstimate, FindsItAmongSeventyPercentOfOutliers) {
  for (uint32_t seed = 0; seed < 100; ++seed) {
    MadeSimilarity made(seed, {.fix_scale = GetParam(), .outliers = 0.7, .noise = 0.7});
    const Similarity result =
        EstimateSimilarity(made.camera(), made.Make(100), Options(GetParam(), seed));
    ASSERT_TRUE(result.ok()) << seed << ": " << result.failure;
    EXPECT_LT(Distance(result.b_from_a, made.b_from_a()), 0.1) << seed;
    EXPECT_GE(result.inliers.size(), 24u);
    EXPECT_GE(result.inliers[1], 70u);
  }
}

TEST_P(SimilarityEstimate, RandomMatchesGiveNoSimilarity) {
  size_t most = 0;
  SimilarityOptions options = Options(GetParam());
  options.ransac.max_iterations = 500;
  for (uint32_t seed = 0; seed < 200; ++seed) {
    MadeSimilarity made(seed, {.fix_scale = GetParam(), .outliers = 1.0});
    options.ransac.seed = seed;
    const Similarity result = EstimateSimilarity(made.camera(), made.Make(100), options);
    EXPECT_FALSE(result.ok());
    most = std::max(most, result.inliers.size());
  }
  EXPECT_LE(most, 7u);  // far from the ten that are needed
}

// The result must not depend on which of the two keyframes is a.
TEST_P(SimilarityEstimate, TheOtherDirectionGivesTheInverse) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    MadeSimilarity made(seed, {.fix_scale = GetParam(), .outliers = 0.4, .noise = 0.3});
    auto matches = made.Make(80);
    const Similarity there = EstimateSimilarity(made.camera(), matches, Options(GetParam(), seed));
    for (SimilarityMatch& match : matches) {
      std::swap(match.point_in_a, match.point_in_b);
      std::swap(match.measured_in_a, match.measured_in_b);
    }
    const Similarity back = EstimateSimilarity(made.camera(), matches, Options(GetParam(), seed));
    ASSERT_TRUE(there.ok() && back.ok());
    EXPECT_EQ(there.inliers, back.inliers);
    EXPECT_LT(Distance(there.b_from_a * back.b_from_a, Sim3()), 1e-4);
  }
}

TEST_P(SimilarityEstimate, TheOrderOfTheMatchesHardlyMatters) {
  MadeSimilarity made(3, {.fix_scale = GetParam(), .outliers = 0.4, .noise = 0.3});
  auto matches = made.Make(100);
  const Similarity before = EstimateSimilarity(made.camera(), matches, Options(GetParam()));
  std::reverse(matches.begin(), matches.end());
  const Similarity after = EstimateSimilarity(made.camera(), matches, Options(GetParam()));
  EXPECT_EQ(after.inliers.size(), before.inliers.size());
  EXPECT_LT(Distance(after.b_from_a, before.b_from_a), 1e-4);
}

TEST_P(SimilarityEstimate, SameSeedGivesTheSameBits) {
  MadeSimilarity made(4, {.fix_scale = GetParam(), .outliers = 0.6, .noise = 0.5});
  const auto matches = made.Make(100);
  const Similarity first = EstimateSimilarity(made.camera(), matches, Options(GetParam(), 9));
  const Similarity second = EstimateSimilarity(made.camera(), matches, Options(GetParam(), 9));
  EXPECT_EQ(first.b_from_a.rotation.coeffs(), second.b_from_a.rotation.coeffs());
  EXPECT_EQ(first.b_from_a.translation, second.b_from_a.translation);
  EXPECT_EQ(first.b_from_a.scale, second.b_from_a.scale);
  EXPECT_EQ(first.inliers, second.inliers);
  EXPECT_EQ(first.iterations, second.iterations);
}

TEST_P(SimilarityEstimate, SkipsMatchesThatAreNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  MadeSimilarity made(7, {.fix_scale = GetParam()});
  auto matches = made.Make(24);
  matches[0].point_in_a.x() = kNan;
  matches[5].point_in_b.y() = kNan;
  matches[9].measured_in_a.measured.x() = std::numeric_limits<double>::infinity();
  matches[23].measured_in_b.inverse_sigma.y() = kNan;
  const Similarity result = EstimateSimilarity(made.camera(), matches, Options(GetParam()));
  ASSERT_TRUE(result.ok());
  EXPECT_LT(Distance(result.b_from_a, made.b_from_a()), 1e-9);
  EXPECT_EQ(result.inliers.size(), 20u);
  EXPECT_EQ(result.inliers.front(), 1u);
  EXPECT_EQ(result.inliers.back(), 22u);
}

TEST_P(SimilarityEstimate, DegenerateMatchesAreAFailure) {
  MadeSimilarity made(8, {.fix_scale = GetParam()});
  const auto points = made.Make(40);
  const auto failure = [&](std::span<const SimilarityMatch> matches) {
    return EstimateSimilarity(made.camera(), matches, Options(GetParam())).failure;
  };
  for (const size_t count : {0, 1, 2, 3, 9}) {
    EXPECT_NE(failure(std::span(points).first(count)).find("there are only"), std::string::npos);
  }
  EXPECT_EQ(failure(std::vector(40, points[0])), "no sample of the matches determines a model");
  std::vector<SimilarityMatch> line;
  for (int i = 0; i < 40; ++i) {
    line.push_back(made.MakeMatch({-1.0 + 0.05 * i, 0.1, 3.0 + 0.02 * i}));
  }
  EXPECT_EQ(failure(line), "no sample of the matches determines a model");
  // A wrong match beside the line: its point in b is rotated about the line, so one rotation agrees
  // with all matches.
  line[7] = points[0];
  const Eigen::Vector3d axis = (line[39].point_in_b - line[0].point_in_b).normalized();
  line[7].point_in_b =
      line[0].point_in_b + ExpSo3(0.2 * axis) * (line[7].point_in_b - line[0].point_in_b);
  line[7].measured_in_b.measured.head<2>() = made.camera().Project(line[7].point_in_b);
  EXPECT_NE(failure(line).find("the matches do not determine rotation and scale"),
            std::string::npos);
  auto behind = points;
  for (SimilarityMatch& match : behind) {
    match.point_in_a *= -1.0;
    match.point_in_b *= -1.0;
  }
  EXPECT_NE(failure(behind).find("there are only 0 usable matches"), std::string::npos);
}

// If two keyframes are at the same place, all scales have the same reprojection errors. Only the
// depths of the landmarks determine the scale.
TEST(Similarity, DepthsGiveTheScaleOfTwoKeyframesAtOnePlace) {
  MadeSimilarity made(9, {.noise = 0.5});
  std::vector<SimilarityMatch> matches;
  for (int i = 0; i < 40; ++i) {
    SimilarityMatch match = made.MakeMatch(made.RandomPoint());
    match.point_in_b = made.random().Number(1.35, 1.65) * match.point_in_a;
    match.measured_in_b = match.measured_in_a;
    matches.push_back(match);
  }
  const Similarity result = EstimateSimilarity(made.camera(), matches, Options(false));
  ASSERT_TRUE(result.ok()) << result.failure;
  EXPECT_NEAR(result.b_from_a.scale, 1.5, 0.05);
  EXPECT_GE(result.inliers.size(), 36u);
}

TEST(Similarity, AFixedScaleStaysOne) {
  MadeSimilarity made(10, {.fix_scale = true, .outliers = 0.3, .noise = 0.5});
  const auto matches = made.Make(60);
  EXPECT_EQ(EstimateSimilarity(made.camera(), matches, Options(true)).b_from_a.scale, 1.0);
  EXPECT_NE(EstimateSimilarity(made.camera(), matches, Options(false)).b_from_a.scale, 1.0);
}

TEST(Similarity, AnotherScaleIsNoRigidMotion) {
  MadeSimilarity made(2, {});
  ASSERT_GT(std::abs(std::log(made.b_from_a().scale)), 0.1);
  EXPECT_FALSE(EstimateSimilarity(made.camera(), made.Make(60), Options(true)).ok());
}

// All keyframes are at the same place, so only the depths of the landmarks constrain the scale.
TEST(Similarity, FewDepthsDoNotDetermineTheScale) {
  MadeSimilarity made(9, {});
  std::vector<SimilarityMatch> matches;
  for (int i = 0; i < 10; ++i) {
    SimilarityMatch match = made.MakeMatch(made.RandomPoint());
    match.point_in_b = 1.5 * match.point_in_a;
    match.measured_in_b = match.measured_in_a;
    matches.push_back(match);
  }
  SimilarityOptions options = Options(false);
  options.ransac.min_inliers = 4;
  EXPECT_TRUE(EstimateSimilarity(made.camera(), matches, options).ok());
  matches.resize(4);
  EXPECT_NE(EstimateSimilarity(made.camera(), matches, options).failure.find("rotation and scale"),
            std::string::npos);
}

// A landmark behind its own camera is of no use, whichever camera it is.
TEST_P(SimilarityEstimate, PassesOverALandmarkBehindItsCamera) {
  MadeSimilarity made(7, {.fix_scale = GetParam()});
  auto matches = made.Make(12);
  matches[1].point_in_a.z() *= -1.0;
  matches[4].point_in_b.z() *= -1.0;
  matches[6].point_in_b.z() = 1e-9;
  EXPECT_EQ(EstimateSimilarity(made.camera(), matches, Options(GetParam())).failure,
            "there are only 9 usable matches, expected at least 10");
}

}  // namespace
}  // namespace hullslam
