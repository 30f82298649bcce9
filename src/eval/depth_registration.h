// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

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
