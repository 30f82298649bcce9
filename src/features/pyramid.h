// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "features/resize.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

// Copies of an image at decreasing sizes. Keeps its buffers from image to image.
class ImagePyramid {
 public:
  explicit ImagePyramid(const ScaleLevels& levels);

  // Level 0 shares the pixels of `grey` (CV_8UC1), which must stay alive as long as level 0 is
  // used. Level l has the size of level 0 divided by scale[l], rounded, as in the ORB of OpenCV,
  // and is resized from level l - 1. Throws CheckError if a level would have no pixel.
  void Build(const cv::Mat& grey);

  const cv::Mat& level(int l) const { return images_[static_cast<size_t>(l)]; }

  // Maps a pixel of level l to level 0. Sizes are rounded, and the centre of a pixel has integer
  // coordinates, so this is (p + 1/2) size_0 / size_l - 1/2. The formula p scale_l of ORB-SLAM2 is
  // wrong by more than a pixel at the upper levels.
  Eigen::Vector2f ToLevelZero(const Eigen::Vector2f& pixel, int l) const;
  // Maps a pixel of level 0 to level l.
  Eigen::Vector2f FromLevelZero(const Eigen::Vector2f& pixel, int l) const;

 private:
  Eigen::Array2f Ratio(int l) const;  // size of level 0 / size of level l

  std::vector<float> scale_;
  std::vector<cv::Mat> images_;
  std::vector<ImageShrinker> shrinkers_;  // one per level; the first is not used
};

}  // namespace hullslam
