// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/stereo_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "util/median.h"

namespace hullslam {
namespace {

// The constants are those of ORB-SLAM2.
constexpr int kMostDifferentBits = 75;  // descriptors that differ in more bits do not match
constexpr float kRowReach = 2.0F;       // rows at the level of the right keypoint
constexpr int kHalfPatch = 5;         // px at the level of the left keypoint; the patch has 11 x 11
constexpr int kReach = 5;             // px; columns to each side in which the patch is shifted
constexpr double kOutlier = 2.1;      // times the median: 1.5 sigma, with 1.4 medians per sigma
constexpr double kLeastMedian = 1.0;  // grey levels; images without noise differ by roundings
constexpr int kSide = 2 * kHalfPatch + 1;

constexpr int kShifts = 2 * kReach + 1;

// The pixels of a patch, row by row, less their mean, so that images of different brightness can be
// compared.
using Patch = std::array<float, size_t{kSide} * kSide>;

bool IsInside(const cv::Mat& image, int x, int y) {
  return x >= kHalfPatch && y >= kHalfPatch && x + kHalfPatch < image.cols &&
         y + kHalfPatch < image.rows;
}

// The patch about a pixel that IsInside.
Patch CutPatch(const cv::Mat& image, int x, int y) {
  Patch patch;
  float sum = 0.0F;
  size_t i = 0;
  for (int row = y - kHalfPatch; row <= y + kHalfPatch; ++row) {
    const uint8_t* const pixels = image.ptr<uint8_t>(row) + x - kHalfPatch;
    for (int column = 0; column < kSide; ++column) {
      patch[i] = static_cast<float>(pixels[column]);
      sum += patch[i++];
    }
  }
  const float mean = sum / static_cast<float>(patch.size());
  for (float& value : patch) {
    value -= mean;
  }
  return patch;
}

// Gaussian weights about the middle, whose mean is 1. Beside a corner at the side of an object the
// patch shows the background, whose disparity is smaller; so the weights fall to 1/e at its rim.
Patch CentreWeights() {
  Patch weights;
  float sum = 0.0F;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide - kHalfPatch);
    const auto y = static_cast<float>(i / kSide - kHalfPatch);
    weights[static_cast<size_t>(i)] = std::exp(-(x * x + y * y) / (kHalfPatch * kHalfPatch));
    sum += weights[static_cast<size_t>(i)];
  }
  for (float& weight : weights) {
    weight *= static_cast<float>(weights.size()) / sum;
  }
  return weights;
}

// One number per shift of the patch. The last ones are not used; they let a compiler work on eight
// at a time.
using PerShift = std::array<float, 16>;
static_assert(kShifts <= PerShift().size());

// The pixels that the shifted patches cover, with columns to spare for the numbers that are not
// used.
class Strip {
 public:
  static constexpr size_t kWidth = static_cast<size_t>(kSide) - 1 + PerShift().size();

  // Beyond the sides of the image the pixels are 0. The rows must lie in it.
  Strip(const cv::Mat& image, int x, int y) {
    const int left = x - kHalfPatch - kReach;
    const int first = std::max(0, -left);
    const int last = std::min(static_cast<int>(kWidth), image.cols - left);
    for (int row = 0; row < kSide; ++row) {
      const uint8_t* const pixels = image.ptr<uint8_t>(y - kHalfPatch + row);
      for (int column = first; column < last; ++column) {
        pixels_[static_cast<size_t>(row) * kWidth + static_cast<size_t>(column)] =
            static_cast<float>(pixels[left + column]);
      }
    }
  }

  // The weighted mean absolute difference of the patch from each of those in the strip, less their
  // means.
  PerShift Differences(const Patch& patch) const {
    const PerShift means = Means();
    PerShift sums{};
    static const Patch weights = CentreWeights();
    ForEachPixel([&](size_t i, const float* pixels) {
      for (size_t shift = 0; shift < sums.size(); ++shift) {
        sums[shift] += weights[i] * std::abs(patch[i] - (pixels[shift] - means[shift]));
      }
    });
    for (float& sum : sums) {
      sum /= static_cast<float>(patch.size());
    }
    return sums;
  }

 private:
  // Calls visit(i, pixels) for each pixel i of a patch; pixels[k] is the one of the k-th shift.
  template <typename Visit>
  void ForEachPixel(const Visit& visit) const {
    for (size_t row = 0; row < size_t{kSide}; ++row) {
      for (size_t column = 0; column < size_t{kSide}; ++column) {
        visit(row * kSide + column, &pixels_[row * kWidth + column]);
      }
    }
  }

  PerShift Means() const {
    PerShift sums{};
    ForEachPixel([&](size_t /*i*/, const float* pixels) {
      for (size_t shift = 0; shift < sums.size(); ++shift) {
        sums[shift] += pixels[shift];
      }
    });
    for (float& sum : sums) {
      sum /= static_cast<float>(kSide * kSide);
    }
    return sums;
  }

  std::array<float, size_t{kSide} * kWidth> pixels_{};
};

struct Fit {
  float column = 0.0F;  // px at the level of the patch
  float difference = 0.0F;
};

// The column at which the patch fits best, about `column`. Nothing if that is the last one that was
// tried, because the best one may lie beyond. The row must have room for a patch.
std::optional<Fit> FitPatch(const Patch& patch, const cv::Mat& image, int column, int row) {
  PerShift differences = Strip(image, column, row).Differences(patch);
  for (int shift = 0; shift < kShifts; ++shift) {
    if (!IsInside(image, column - kReach + shift, row)) {
      differences[static_cast<size_t>(shift)] = std::numeric_limits<float>::infinity();
    }
  }
  const auto best = std::min_element(differences.begin(), differences.begin() + kShifts);
  const auto at = static_cast<int>(best - differences.begin());
  if (at == 0 || at == kShifts - 1 || !std::isfinite(*(best - 1)) || !std::isfinite(*(best + 1))) {
    return std::nullopt;
  }
  const float before = *(best - 1);
  const float after = *(best + 1);
  const float curvature = before + after - 2.0F * *best;
  const float offset = curvature > 0.0F ? 0.5F * (before - after) / curvature : 0.0F;
  return Fit{static_cast<float>(column + at - kReach) + offset, *best};
}

float MedianDifference(std::span<const float> differences) {
  std::vector<float> found;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(found),
               [](float difference) { return std::isfinite(difference); });
  return found.empty() ? 0.0F : Median(std::move(found));
}

}  // namespace

StereoMatcher::StereoMatcher(const ScaleLevels& levels, double largest_disparity)
    : scale_(levels.scale), largest_disparity_(static_cast<float>(largest_disparity)) {}

void StereoMatcher::SortIntoRows(const StereoImage& right) {
  const int count = right.pyramid.level(0).rows;
  rows_.resize(static_cast<size_t>(count));
  for (std::vector<uint32_t>& row : rows_) {
    row.clear();
  }
  for (uint32_t i = 0; i < right.features.keypoints.size(); ++i) {
    const RawKeypoint& keypoint = right.features.keypoints[i];
    const float reach = kRowReach * scale_[static_cast<size_t>(keypoint.level)];
    const int first = std::max(0, static_cast<int>(std::floor(keypoint.raw.y() - reach)));
    const int last = std::min(count - 1, static_cast<int>(std::ceil(keypoint.raw.y() + reach)));
    for (int row = first; row <= last; ++row) {
      rows_[static_cast<size_t>(row)].push_back(i);
    }
  }
}

StereoMatcher::Found StereoMatcher::MatchOne(const StereoImage& left, const StereoImage& right,
                                             size_t keypoint) const {
  const RawKeypoint& seen = left.features.keypoints[keypoint];
  const auto row = static_cast<size_t>(
      std::clamp(std::lround(seen.raw.y()), 0L, static_cast<long>(rows_.size()) - 1));
  int least = kMostDifferentBits + 1;
  const RawKeypoint* best = nullptr;
  for (const uint32_t i : rows_[row]) {
    const RawKeypoint& candidate = right.features.keypoints[i];
    const float disparity = seen.raw.x() - candidate.raw.x();
    if (std::abs(candidate.level - seen.level) > 1 || disparity < 0.0F ||
        disparity > largest_disparity_) {
      continue;
    }
    const int bits =
        HammingDistance(left.features.descriptors[keypoint], right.features.descriptors[i]);
    if (bits < least) {
      least = bits;
      best = &candidate;
    }
  }
  if (best == nullptr) {
    return {};
  }
  const Eigen::Vector2f centre = left.pyramid.FromLevelZero(seen.raw, seen.level);
  const Eigen::Vector2f other = right.pyramid.FromLevelZero(best->raw, seen.level);
  const int column = static_cast<int>(std::lround(centre.x()));
  const int line = static_cast<int>(std::lround(centre.y()));
  const cv::Mat& image = left.pyramid.level(seen.level);
  if (!IsInside(image, column, line)) {
    return {};
  }
  const std::optional<Fit> fit =
      FitPatch(CutPatch(image, column, line), right.pyramid.level(seen.level),
               static_cast<int>(std::lround(other.x())), line);
  if (!fit) {
    return {};
  }
  const Eigen::Vector2f of_patch =
      left.pyramid.ToLevelZero({static_cast<float>(column), static_cast<float>(line)}, seen.level);
  const Eigen::Vector2f of_fit =
      right.pyramid.ToLevelZero({fit->column, static_cast<float>(line)}, seen.level);
  return {of_patch.x() - of_fit.x(), fit->difference};
}

std::vector<float> StereoMatcher::Match(const StereoImage& left, const StereoImage& right,
                                        TaskRunner& runner) {
  constexpr size_t kInTask = 128;
  const size_t count = left.features.keypoints.size();
  std::vector<float> disparities(count, 0.0F);
  std::vector<float> differences(count, std::numeric_limits<float>::infinity());
  SortIntoRows(right);
  runner.Run((count + kInTask - 1) / kInTask, [&](size_t task) {
    for (size_t i = task * kInTask; i < std::min(count, (task + 1) * kInTask); ++i) {
      const Found found = MatchOne(left, right, i);
      if (found.disparity > 0.0F && found.disparity <= largest_disparity_) {
        disparities[i] = found.disparity;
        differences[i] = found.difference;
      }
    }
  });
  const double bound =
      kOutlier * std::max(kLeastMedian, static_cast<double>(MedianDifference(differences)));
  for (size_t i = 0; i < count; ++i) {
    if (static_cast<double>(differences[i]) > bound) {
      disparities[i] = 0.0F;
    }
  }
  return disparities;
}

}  // namespace hullslam
