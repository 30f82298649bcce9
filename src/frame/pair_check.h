// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "features/extractor.h"

namespace hullslam {

// Finds faults of the pairs of a stereo camera that a run would not notice: it compares keypoints
// of the two images wherever they are, not only in equal rows.
class PairCheck {
 public:
  static constexpr size_t kFewestMatches = 30;  // fewer say nothing

  // The matches of one pair, and how many of them are in other rows.
  struct PairRows {
    size_t matches = 0;
    size_t off = 0;
  };

  // The images are those that the run uses, CV_8UC1 of equal sizes.
  PairRows Add(const cv::Mat& left, const cv::Mat& right);
  // The same with the features of both images, which have this height, px.
  PairRows Add(const ExtractedFeatures& left, const ExtractedFeatures& right, int height);

  size_t matches() const { return rows_.size(); }
  // The fault of the pairs, for a message that begins with their name; nothing if they are as
  // they should be, or if there are too few matches to say so.
  std::optional<std::string> FindFault() const;

 private:
  std::vector<double> columns_;  // left - right, px, of each match
  std::vector<double> rows_;     // left - right, px
};

}  // namespace hullslam
