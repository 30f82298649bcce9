// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/ransac.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

// A problem whose model is the number that most of the given numbers are near to. An error of 1 is
// a distance of 1.
class CenterProblem {
 public:
  using Model = double;
  static constexpr size_t kSampleSize = 1;

  explicit CenterProblem(std::vector<double> numbers) : numbers_(std::move(numbers)) {}

  size_t size() const { return numbers_.size(); }
  void Solve(const std::array<size_t, 1>& sample, std::vector<double>& models) const {
    if (numbers_[sample[0]] != kDegenerate) {
      models.push_back(numbers_[sample[0]]);
    }
  }
  double Error(double center, size_t i) const {
    return (numbers_[i] - center) * (numbers_[i] - center);
  }
  std::optional<double> Refine(double, const std::vector<size_t>& inliers) const {
    const double sum = std::accumulate(inliers.begin(), inliers.end(), 0.0,
                                       [&](double part, size_t i) { return part + numbers_[i]; });
    return sum / static_cast<double>(inliers.size());
  }

  static constexpr double kDegenerate = 1e9;

 private:
  std::vector<double> numbers_;
};

TEST(Ransac, FindsTheModelByHand) {
  const CenterProblem problem({50.0, 5.0, 5.2, 70.0, 4.8, 90.0});
  const auto result = Ransac(problem, {.min_inliers = 3});
  ASSERT_TRUE(result.ok()) << result.failure;
  EXPECT_DOUBLE_EQ(result.model, 5.0);
  EXPECT_EQ(result.inliers, (std::vector<size_t>{1, 2, 4}));
  EXPECT_NEAR(result.score, 3.0 - 2.0 * 0.04, 1e-12);
}

// Without the local optimisation the model would be one of the numbers.
TEST(Ransac, FitsTheModelToAllInliers) {
  const CenterProblem problem({0.0, 0.3, 0.5, 0.9, 30.0});
  EXPECT_DOUBLE_EQ(Ransac(problem, {.min_inliers = 3}).model, 0.425);
}

TEST(Ransac, EndsEarlyWhenThereAreFewOutliers) {
  std::vector<double> numbers(90, 1.0);
  numbers.resize(100);
  std::iota(numbers.begin() + 90, numbers.end(), 100.0);
  const auto few = Ransac(CenterProblem(numbers), {.min_inliers = 3});
  EXPECT_LE(few.iterations, 5);
  // With a share of 2 %, log(0.001) / log(0.98) = 342 samples are needed.
  numbers.assign(100, 0.0);
  std::iota(numbers.begin(), numbers.end(), 100.0);
  numbers[1] = numbers[0];
  const auto many = Ransac(CenterProblem(numbers), {.min_inliers = 2});
  EXPECT_EQ(many.iterations, 342);
  EXPECT_EQ(Ransac(CenterProblem(numbers), {.max_iterations = 50, .min_inliers = 2}).iterations,
            50);
}

TEST(Ransac, FailuresHaveAReason) {
  const CenterProblem problem({1.0, 1.0, 1.0, 9.0});
  EXPECT_EQ(Ransac(problem, {.min_inliers = 5}).failure,
            "there are only 4 usable matches, expected at least 5");
  EXPECT_EQ(Ransac(problem, {.min_inliers = 4}).failure,
            "only 3 of 4 matches agree, expected at least 4");
  EXPECT_EQ(Ransac(CenterProblem({}), {}).failure,
            "there are only 0 usable matches, expected at least 10");
  EXPECT_EQ(
      Ransac(CenterProblem(std::vector<double>(4, CenterProblem::kDegenerate)), {.min_inliers = 2})
          .failure,
      "no sample of the matches determines a model");
}

// A sample always agrees with its own model, so one inlier more is needed in any case.
TEST(Ransac, ASampleAloneIsNeverEnough) {
  const auto result = Ransac(CenterProblem({1.0, 10.0, 20.0}), {.min_inliers = 0});
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.inliers.size(), 1u);
}

TEST(Ransac, SamplesHaveDifferentMembersOfAll) {
  std::mt19937_64 random(1);
  std::set<size_t> drawn;
  for (int i = 0; i < 1000; ++i) {
    const auto sample = internal::DrawSample<3>(5, random);
    EXPECT_EQ(std::set<size_t>(sample.begin(), sample.end()).size(), 3u);
    drawn.insert(sample.begin(), sample.end());
  }
  EXPECT_EQ(drawn, (std::set<size_t>{0, 1, 2, 3, 4}));
}

TEST(Ransac, SamplesNeededByHand) {
  // log(0.01) / log(1 - 0.5^3) = 34.5
  EXPECT_EQ(internal::SamplesNeeded(0.5, 3, 0.99, 1000), 35);
  EXPECT_EQ(internal::SamplesNeeded(0.5, 3, 0.99, 20), 20);
  EXPECT_EQ(internal::SamplesNeeded(0.0, 3, 0.99, 1000), 1000);
  EXPECT_EQ(internal::SamplesNeeded(1.0, 3, 0.99, 1000), 0);
}

TEST(Ransac, TheSeedDecides) {
  RandomGeometry random(1);
  std::vector<double> numbers;
  for (int i = 0; i < 200; ++i) {
    numbers.push_back(random.Number(0.0, 40.0));
  }
  const CenterProblem problem(numbers);
  std::set<double> models;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const RansacOptions options{.seed = seed, .max_iterations = 3, .min_inliers = 2};
    const auto result = Ransac(problem, options);
    EXPECT_EQ(result.model, Ransac(problem, options).model);
    models.insert(result.model);
  }
  EXPECT_GT(models.size(), 5u);
}

}  // namespace
}  // namespace hullslam
