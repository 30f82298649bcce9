// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/stereo_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include "frame/patch_fit.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// The constants are those of ORB-SLAM2.
constexpr int kMostDifferentBits = 75;  // descriptors that differ in more bits do not match
constexpr float kRowReach = 2.0F;       // rows at the level of the right keypoint
constexpr double kOutlier = 2.1;        // times the median: 1.5 sigma, with 1.4 medians per sigma
constexpr double kLeastMedian = 1.0;    // grey levels; images without noise differ by roundings
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
  const std::optional<PatchFit> fit =
      FitPatch(left.pyramid.level(seen.level), {column, line}, right.pyramid.level(seen.level),
               static_cast<int>(std::lround(other.x())));
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
  const size_t count = left.features.keypoints.size();
  std::vector<float> disparities(count, 0.0F);
  std::vector<float> differences(count, std::numeric_limits<float>::infinity());
  SortIntoRows(right);
  runner.RunEach(count, [&](size_t i) {
    const Found found = MatchOne(left, right, i);
    if (found.disparity > 0.0F && found.disparity <= largest_disparity_) {
      disparities[i] = found.disparity;
      differences[i] = found.difference;
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

StereoFeatures::StereoFeatures(const FeatureOptions& features, const PinholeCamera& camera)
    : extractor_(features, true), matcher_(extractor_.levels(), camera.fx) {}

ExtractedFeatures StereoFeatures::Extract(FeatureExtractor& left_extractor, const cv::Mat& left,
                                          const cv::Mat& right, TaskRunner& runner,
                                          const std::array<cv::Mat, 2>& ignored) {
  std::array<ExtractedFeatures, 2> both =
      FeatureExtractor::ExtractPair({&left_extractor, &extractor_}, {left, right}, runner, ignored);
  right_ = std::move(both[1]);
  return std::move(both[0]);
}

std::vector<float> StereoFeatures::FindDisparities(const ExtractedFeatures& left,
                                                   const ImagePyramid& left_pyramid,
                                                   TaskRunner& runner) {
  return matcher_.Match({left, left_pyramid}, {right_, extractor_.pyramid()}, runner);
}

}  // namespace hullslam
