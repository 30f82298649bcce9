// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <span>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// Measures whether masks belong to the pixels of their images. The outline of an object runs along
// borders in the image; the outline of a mask of another image, or of a turned image, runs
// anywhere.
class MaskRegistration {
 public:
  // Adds the contours of an image (CV_8UC1).
  void Add(const cv::Mat& grey, std::span<const InstanceMask> masks);

  // The length of all contours, px.
  size_t points() const { return points_; }
  // The mean gradient along the contours, divided by the mean of the whole images, if the masks are
  // of the image turned by an orientation of EXIF, 1 (as stored) to 8. It is about 1 if masks
  // and images have nothing to do with each other. Requires points() > 0.
  double Contrast(int orientation) const;

 private:
  size_t points_ = 0;
  std::array<double, 9> gradients_{};  // sums by orientation
};

}  // namespace hullslam
