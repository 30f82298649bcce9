// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

namespace hullslam {

struct Corner {
  int16_t x = 0;  // px
  int16_t y = 0;
  // The largest threshold (grey levels) at which the pixel is a FAST corner.
  int16_t score = 0;
  // Scores of the four neighbours, for SubpixelOffset().
  uint8_t left = 0;
  uint8_t right = 0;
  uint8_t above = 0;
  uint8_t below = 0;
};

// Offset from the pixel of a corner to the maximum of the parabolas through its score and the
// scores of its neighbours. At most half a pixel in x and in y.
Eigen::Vector2f SubpixelOffset(const Corner& corner);

// FAST-9/16 corners (Rosten and Drummond 2006) that are maxima of their 3 x 3 neighbourhood; among
// equal neighbours the first in raster order is kept. Keeps its buffers from image to image.
class CornerDetector {
 public:
  // The image has cells of about 30 px. A cell without a corner at `initial_threshold` gets the
  // corners at `minimum_threshold` (both in grey levels, at least 1).
  CornerDetector(int initial_threshold, int minimum_threshold);

  // Finds the corners that are at least `border` px (8 or more) away from the outermost pixels of
  // `image` (CV_8UC1), in raster order. `corners` is overwritten. The result is as if there were no
  // corners where `is_ignored` (which may be empty) is true.
  void Detect(const cv::Mat& image, int border, std::vector<Corner>& corners,
              const std::function<bool(const Corner&)>& is_ignored = {});

 private:
  void FindMaxima(const cv::Mat& image, int border, std::vector<Corner>& corners);
  void DropWeakInStrongCells(const cv::Mat& image, std::vector<Corner>& corners);

  int initial_threshold_;
  int minimum_threshold_;
  std::vector<uint8_t> score_rows_;  // scores of three image rows, in a ring buffer
  std::vector<uint8_t> maxima_;  // scores of the pixels of one row that are maxima, 0 for others
  std::vector<uint8_t> strong_;  // per cell: has a corner at the initial threshold
  std::vector<uint32_t> cell_of_corner_;
};

// Whether the patch around `center` is a straight edge, along which nothing tells its position. The
// patch must be inside `image` (CV_8UC1): 4 px on each side of the centre.
//
// The covariance of the position of a patch is the noise of the grey levels times the inverse of
// the structure tensor, the sum over the patch of g g^T with the gradients g (Foerstner and Guelch
// 1987). If the larger eigenvalue of the tensor is r times the smaller one, the position along the
// edge is sqrt(r) times less precise than across it. Across it, corners are precise to 0.6 px
// (freiburg1_xyz, docs/monocular.md). With r = 16 that is 2.4 px along the edge, and this is the
// bound of an inlier: the root of 5.99 sigma^2 with the assumed sigma of 1 px. So a landmark on
// such an edge agrees with many wrong matches: the same edge has other corners nearby, which look
// alike.
bool IsStraightEdge(const cv::Mat& image, cv::Point center);

}  // namespace hullslam
