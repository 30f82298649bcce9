// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

struct Corner {
  int16_t x = 0;  // px
  int16_t y = 0;
  // Largest threshold (grey levels) with which the pixel is a FAST corner.
  int16_t score = 0;
  // Scores of the neighbours, for a refined position.
  uint8_t left = 0;
  uint8_t right = 0;
  uint8_t above = 0;
  uint8_t below = 0;
};

// From the pixel of a corner to the top of the parabolas through its score and those of its
// neighbours, at most half a pixel in x and in y.
Eigen::Vector2f SubpixelOffset(const Corner& corner);

// FAST-9/16 corners (Rosten and Drummond 2006) that are maxima of their 3 x 3 neighbourhood. Of
// equal neighbours the first in raster order is one. Keeps its buffers from image to image.
class CornerDetector {
 public:
  // In cells of about 30 px that have no corner of `initial_threshold` those of
  // `minimum_threshold` (grey levels, at least 1) are taken.
  CornerDetector(int initial_threshold, int minimum_threshold);

  // Corners at least `border` px (8 or more) away from the outermost pixels of `image` (CV_8UC1),
  // in raster order; `corners` is overwritten.
  void Detect(const cv::Mat& image, int border, std::vector<Corner>& corners);

 private:
  void FindMaxima(const cv::Mat& image, int border, std::vector<Corner>& corners);
  void DropWeakInStrongCells(const cv::Mat& image, std::vector<Corner>& corners);

  int initial_threshold_;
  int minimum_threshold_;
  std::vector<uint8_t> score_rows_;  // of three image rows, as a ring
  std::vector<uint8_t> maxima_;      // of one row: the score where it is a maximum, else 0
  std::vector<uint8_t> strong_;      // of a cell: has a corner of the initial threshold
  std::vector<uint32_t> cell_of_corner_;
};

}  // namespace hullslam
