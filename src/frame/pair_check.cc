// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/pair_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "features/extractor.h"
#include "util/order_statistics.h"

namespace hullslam {
namespace {

constexpr int kMostBits = 50;        // of a match that counts here
constexpr double kSecondBest = 0.8;  // a match has at most this share of the bits of the next one
constexpr double kMostRows = 0.08;   // of the height; a pair that is set up badly is off by less
constexpr double kSame = 0.05;       // px; two copies of one image differ by less
// Calibrated pairs are off by a few tenths of a pixel. Matches are sought in rows that are two
// pixels away, so a pair that is off by more loses most of them.
constexpr double kMostRowDifference = 1.5;  // px

double MedianOf(std::vector<double> values) { return Median(std::move(values)); }

}  // namespace

PairCheck::PairRows PairCheck::Add(const cv::Mat& left, const cv::Mat& right) {
  FeatureExtractor extractor{FeatureOptions()};
  const ExtractedFeatures of_left = extractor.Extract(left);
  return Add(of_left, extractor.Extract(right), left.rows);
}

PairCheck::PairRows PairCheck::Add(const ExtractedFeatures& a, const ExtractedFeatures& b,
                                   int height) {
  const double most_rows = kMostRows * height;
  PairRows counts;
  for (size_t i = 0; i < a.keypoints.size(); ++i) {
    int best = kMostBits + 1;
    int second = 256;
    size_t found = 0;
    for (size_t k = 0; k < b.keypoints.size(); ++k) {
      const double rows = static_cast<double>(a.keypoints[i].raw.y() - b.keypoints[k].raw.y());
      if (std::abs(a.keypoints[i].level - b.keypoints[k].level) > 1 || std::abs(rows) > most_rows) {
        continue;
      }
      const int bits = HammingDistance(a.descriptors[i], b.descriptors[k]);
      if (bits < best) {
        second = best;
        best = bits;
        found = k;
      } else if (bits < second) {
        second = bits;
      }
    }
    if (best <= kMostBits && best <= kSecondBest * second) {
      const Eigen::Vector2d moved = (a.keypoints[i].raw - b.keypoints[found].raw).cast<double>();
      columns_.push_back(moved.x());
      rows_.push_back(moved.y());
      ++counts.matches;
      counts.off += std::abs(moved.y()) > kMostRowDifference ? 1 : 0;
    }
  }
  return counts;
}

std::optional<std::string> PairCheck::FindFault() const {
  if (rows_.size() < kFewestMatches) {
    return std::nullopt;
  }
  const double column = MedianOf(columns_);
  const double row = MedianOf(rows_);
  if (std::abs(column) < kSame && std::abs(row) < kSame) {
    return "left and right show the same image, expected those of two cameras";
  }
  const auto to_the_right = static_cast<size_t>(
      std::count_if(columns_.begin(), columns_.end(), [](double moved) { return moved < -kSame; }));
  if (2 * to_the_right > columns_.size()) {
    return fmt::format(
        "{} of {} points lie farther right in the right image than in the left one: left and right "
        "are swapped",
        to_the_right, columns_.size());
  }
  if (std::abs(row) > kMostRowDifference) {
    return fmt::format(
        "points lie {:.1f} px {} in the right image than in the left one (median of {}), expected "
        "equal rows: the calibration does not fit, or the images are not rectified",
        std::abs(row), row > 0.0 ? "higher" : "lower", rows_.size());
  }
  return std::nullopt;
}

}  // namespace hullslam
