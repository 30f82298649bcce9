// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// The magnitude of the gradient of an image (CV_8UC1), divided by its mean: CV_32FC1. Strong edges
// are limited, so that a few of them do not decide what is measured with it.
cv::Mat RelativeGradient(const cv::Mat& grey);

// The same with directions, CV_32FC2.
cv::Mat RelativeGradientVectors(const cv::Mat& grey);

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

// Measures whether depth images are registered to their colour images. Where the depth has a step,
// there is the border of something near, and the colour image usually changes there too. If the
// depth image is moved or scaled against the colour image, it changes there no more than elsewhere.
class DepthRegistration {
 public:
  // Adds an image (CV_8UC1) and its depth image of the same shape, CV_16UC1 or CV_32FC1 in any
  // unit. Both are compared at the size of the smaller one, at most at 640 x 480 px: larger
  // images have wider borders, and a smaller depth image does not know its steps to a pixel of the
  // other.
  void Add(const cv::Mat& grey, const cv::Mat& depth);

  // The number of pixels at steps of the depth.
  size_t edges() const { return edges_; }
  // The gradient of the colour images across the steps, divided by its mean if the depth images are
  // moved by up to a thirteenth of their size. It is about 1 if they are not registered. The
  // largest value within a shift by 1/160 of the size counts: the two images of a pair are taken up
  // to 0.02 s apart, and a camera that turns by 15 degrees per second moves the image by that much
  // meanwhile. Requires edges() > 0.
  double Contrast() const;
  // The same for the shift by more than 1/80 of the size at which it is largest.
  double ContrastElsewhere() const;

 private:
  // The largest contrast of the shifts by `from` to `to` steps.
  double LargestWithin(int from, int to) const;

  size_t edges_ = 0;
  std::vector<double> gradients_;  // sum over the steps for each shift; the middle one is no shift
};

}  // namespace hullslam
