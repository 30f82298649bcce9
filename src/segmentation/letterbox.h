// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace hullslam {

// How an image lies in the input of a network: scaled without distortion, in the middle, with grey
// around it.
//
// Here coordinates run along the edges of pixels: the first pixel of an image covers 0 to 1, and
// its centre is at 0.5. An input point is scale * image point + offset.
struct Letterbox {
  cv::Size image;
  cv::Size input;
  cv::Size scaled;        // size of the image in the input
  Eigen::Array2d scale;   // of x and y: they differ a little, because sizes are whole numbers
  Eigen::Array2d offset;  // px of the input

  Eigen::Array2d ToImage(const Eigen::Array2d& input_point) const {
    return (input_point - offset) / scale;
  }
};

// The letterbox of an image in an input of this size.
Letterbox FitLetterbox(const cv::Size& image, const cv::Size& input);

// The smallest input for an image whose longer side gets `longer` px: both sides are multiples of
// 32, the largest stride of YOLO.
cv::Size InputSize(const cv::Size& image, int longer);

// The input of the network, 1x3xHxW, red first, values from 0 to 1. `image` is CV_8UC3 or
// CV_8UC4 with blue first, or CV_8UC1.
cv::Mat MakeInput(const cv::Mat& image, const Letterbox& letterbox);

}  // namespace hullslam
