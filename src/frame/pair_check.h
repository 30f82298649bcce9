// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace hullslam {

// Finds faults of the pairs of a stereo camera that a run would not notice: it compares keypoints
// of the two images wherever they are, not only in equal rows.
class PairCheck {
 public:
  // The images are those that the run uses, CV_8UC1 of equal sizes.
  void Add(const cv::Mat& left, const cv::Mat& right);

  size_t matches() const { return rows_.size(); }
  // The fault of the pairs, for a message that begins with their name; nothing if they are as
  // they should be, or if there are too few matches to say so.
  std::optional<std::string> FindFault() const;

 private:
  std::vector<double> columns_;  // left - right, px, of each match
  std::vector<double> rows_;     // left - right, px
};

}  // namespace hullslam
