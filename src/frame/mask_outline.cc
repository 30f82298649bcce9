// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/mask_outline.h"

#include <opencv2/imgproc.hpp>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Makes a lattice with twice the resolution and one empty line around it. Each point of the lattice
// is the centre of a pixel, the middle of an edge between two pixels, or a corner of four pixels.
// The centre of pixel (x, y) is at (2x + 2, 2y + 2). A middle is inside if at least one of its two
// pixels is inside; a corner is inside if at least two of its four pixels are. So the outermost
// inside points are the middles of the edges of the mask and, along straight edges, also the
// corners.
cv::Mat MakeLattice(const cv::Mat& mask) {
  cv::Mat padded;
  cv::copyMakeBorder(mask != 0, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat lattice = cv::Mat::zeros(2 * mask.rows + 3, 2 * mask.cols + 3, CV_8UC1);
  for (int y = 0; y <= mask.rows; ++y) {
    const auto* const above = padded.ptr<uint8_t>(y);
    const auto* const here = padded.ptr<uint8_t>(y + 1);
    auto* const corners = lattice.ptr<uint8_t>(2 * y + 1);
    auto* const centers = lattice.ptr<uint8_t>(2 * y + 2);
    for (int x = 0; x <= mask.cols; ++x) {
      const int count = (above[x] & 1) + (above[x + 1] & 1) + (here[x] & 1) + (here[x + 1] & 1);
      corners[2 * x + 1] = count >= 2 ? 1 : 0;
      corners[2 * x + 2] = above[x + 1] | here[x + 1];
      centers[2 * x + 1] = here[x] | here[x + 1];
      centers[2 * x + 2] = here[x + 1];
    }
  }
  return lattice;
}

}  // namespace

std::vector<std::vector<Eigen::Vector2d>> FindMaskOutlines(const cv::Mat& mask) {
  Check(mask.type() == CV_8UC1, "the mask is not CV_8UC1");
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(MakeLattice(mask), contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  std::vector<std::vector<Eigen::Vector2d>> outlines;
  for (const std::vector<cv::Point>& contour : contours) {
    std::vector<Eigen::Vector2d>& outline = outlines.emplace_back();
    for (const cv::Point& point : contour) {
      outline.emplace_back(0.5 * point.x - 1.0, 0.5 * point.y - 1.0);
    }
  }
  return outlines;
}

}  // namespace hullslam
