// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace hullslam {

struct RansacOptions {
  // Two calls with the same seed and input give the same bits. Use HashSeed(run seed, frame,
  // purpose).
  uint64_t seed = 0;
  // The search ends when the probability is this large that one of the samples had no outliers.
  double confidence = 0.999;
  int max_iterations = 1000;
  // With fewer inliers the search fails. A model always needs more inliers than a sample has
  // matches.
  size_t min_inliers = 10;
};

template <typename Model>
struct RansacResult {
  Model model;
  std::vector<size_t> inliers;  // indices of matches, increasing
  double score = 0.0;           // sum of 1 - error over the inliers
  int iterations = 0;
  std::string failure;  // empty if the model was found, else the reason

  bool ok() const { return failure.empty(); }
};

namespace internal {

// The number of samples of `sample_size` matches after which, with probability `confidence`, one of
// them had only inliers. At most `most`.
inline int SamplesNeeded(double inlier_share, size_t sample_size, double confidence, int most) {
  const double good = std::pow(inlier_share, static_cast<double>(sample_size));
  // With 1 - good = 1 the quotient is infinite, and with 1 - good = 0 it is 0.
  const double needed = std::log1p(-confidence) / std::log1p(-good);
  return needed < most ? static_cast<int>(std::ceil(needed)) : most;
}

// Different indices below `count`, which is at least kSize.
template <size_t kSize>
std::array<size_t, kSize> DrawSample(size_t count, std::mt19937_64& random) {
  std::array<size_t, kSize> sample;
  for (auto index = sample.begin(); index != sample.end();) {
    *index = random() % count;
    index += std::find(sample.begin(), index, *index) == index ? 1 : 0;
  }
  return sample;
}

// The state of the search for one problem.
template <typename Problem>
class RansacSearch {
 public:
  using Model = typename Problem::Model;

  RansacSearch(const Problem& problem, size_t min_inliers, const RansacOptions& options)
      : problem_(problem),
        min_inliers_(min_inliers),
        options_(options),
        lowest_cost_(static_cast<double>(problem.size())) {}

  RansacResult<Model> Run() {
    std::mt19937_64 random(options_.seed);
    int needed = options_.max_iterations;
    std::vector<Model> models;
    while (result_.iterations < needed) {
      ++result_.iterations;
      models.clear();
      problem_.Solve(DrawSample<Problem::kSampleSize>(problem_.size(), random), models);
      has_model_ = has_model_ || !models.empty();
      for (const Model& model : models) {
        if (Consider(model)) {
          Improve();
          const double share =
              static_cast<double>(result_.inliers.size()) / static_cast<double>(problem_.size());
          needed = SamplesNeeded(share, Problem::kSampleSize, options_.confidence,
                                 options_.max_iterations);
        }
      }
    }
    Conclude();
    return std::move(result_);
  }

 private:
  // The sum of min(error, 1) (MSAC, Torr and Zisserman 2000), or a part of it that is not below
  // `bound`.
  double Cost(const Model& model, double bound) const {
    double cost = 0.0;
    for (size_t i = 0; i < problem_.size() && cost < bound; ++i) {
      const double error = problem_.Error(model, i);
      cost += error < 1.0 ? error : 1.0;  // 1 for a NaN
    }
    return cost;
  }

  // Keeps the model if it is better than all before; ties go to the first.
  bool Consider(const Model& model) {
    const double cost = Cost(model, lowest_cost_);
    if (!(cost < lowest_cost_)) {
      return false;
    }
    lowest_cost_ = cost;
    result_.model = model;
    result_.inliers.clear();
    for (size_t i = 0; i < problem_.size(); ++i) {
      if (problem_.Error(model, i) < 1.0) {
        result_.inliers.push_back(i);
      }
    }
    return true;
  }

  // Local optimisation (Chum, Matas and Kittler 2003): fits the model to all its inliers and
  // chooses the inliers again, as long as the cost falls.
  void Improve() {
    constexpr int kRounds = 6;
    for (int round = 0; round < kRounds && result_.inliers.size() > Problem::kSampleSize; ++round) {
      const std::optional<Model> refined = problem_.Refine(result_.model, result_.inliers);
      if (!refined || !Consider(*refined)) {
        return;
      }
    }
  }

  void Conclude() {
    result_.score = static_cast<double>(problem_.size()) - lowest_cost_;
    if (!has_model_) {
      result_.failure = "no sample of the matches determines a model";
    } else if (result_.inliers.size() < min_inliers_) {
      result_.failure = "only " + std::to_string(result_.inliers.size()) + " of " +
                        std::to_string(problem_.size()) + " matches agree, expected at least " +
                        std::to_string(min_inliers_);
    }
  }

  const Problem& problem_;
  const size_t min_inliers_;
  const RansacOptions& options_;
  double lowest_cost_;
  bool has_model_ = false;
  RansacResult<Model> result_;
};

}  // namespace internal

// Finds the model that most matches agree with, although many of them are wrong (RANSAC, Fischler
// and Bolles 1981, with the score of MSAC and with local optimisation). A Problem has
//   using Model                           default-constructible
//   static constexpr size_t kSampleSize   the number of matches that determine a model
//   size_t size()                         the number of matches
//   void Solve(const std::array<size_t, kSampleSize>&, std::vector<Model>&)
//                                         adds the models of a sample, none if it is degenerate
//   double Error(const Model&, size_t)    squared error of a match; 1 is the bound of an inlier
//   std::optional<Model> Refine(const Model&, const std::vector<size_t>& inliers)
//                                         a model that fits the inliers better, if there is one
// A failed result has the best model that was found; use it in messages only.
template <typename Problem>
RansacResult<typename Problem::Model> Ransac(const Problem& problem, const RansacOptions& options) {
  const size_t least = std::max(options.min_inliers, Problem::kSampleSize + 1);
  if (problem.size() < least) {
    RansacResult<typename Problem::Model> result;
    result.failure = "there are only " + std::to_string(problem.size()) +
                     " usable matches, expected at least " + std::to_string(least);
    return result;
  }
  return internal::RansacSearch<Problem>(problem, least, options).Run();
}

}  // namespace hullslam
