// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hullslam/features/feature_set.h"

namespace hullslam {

// Smaller and smaller copies of an image. Keeps its buffers from image to image.
class ImagePyramid {
 public:
  explicit ImagePyramid(const ScaleLevels& levels);

  // Level 0 shares the pixels of `grey` (CV_8UC1), which must live as long as it is used. Level l
  // has the size of level 0 divided by scale[l], rounded, as in OpenCV's ORB, and is resized from
  // level l - 1. Throws CheckError where a level would have no pixel.
  void Build(const cv::Mat& grey);

  const cv::Mat& level(int l) const { return images_[static_cast<size_t>(l)]; }

  // Level-0 pixel of a pixel of level l. Sizes are rounded and pixels are areas around their
  // centre, so this is (p + 1/2) size_0 / size_l - 1/2; ORB-SLAM2's p scale_l is off by more than a
  // pixel at the upper levels.
  Eigen::Vector2f ToLevelZero(const Eigen::Vector2f& pixel, int l) const;

 private:
  std::vector<float> scale_;
  std::vector<cv::Mat> images_;
};

}  // namespace hullslam
