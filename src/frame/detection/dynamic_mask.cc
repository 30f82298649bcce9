// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/dynamic_mask.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hullslam {

cv::Mat DynamicMask(std::span<const InstanceMask> masks, const std::set<std::string>& classes,
                    cv::Size size) {
  cv::Mat region;
  cv::Rect box;  // bounding box of the filled pixels
  for (const InstanceMask& mask : masks) {
    if (!classes.contains(mask.label)) {
      continue;
    }
    if (region.empty()) {
      region = cv::Mat::zeros(size, CV_8UC1);
    }
    for (const std::vector<Eigen::Vector2d>& outline : mask.outlines) {
      std::vector<cv::Point> polygon;
      polygon.reserve(outline.size());
      for (const Eigen::Vector2d& point : outline) {
        // Far outside any image, but OpenCV's fixed-point arithmetic does not overflow there.
        constexpr double kFar = 32000.0;
        polygon.emplace_back(cvRound(std::clamp(point.x(), -kFar, kFar)),
                             cvRound(std::clamp(point.y(), -kFar, kFar)));
      }
      cv::fillPoly(region, std::vector{polygon}, cv::Scalar(255));
      box |= cv::boundingRect(polygon);
    }
  }
  if (region.empty()) {
    return region;
  }
  // Dilates only around the filled pixels, because the rest of the image is zero.
  const cv::Rect grown(box.x - kMaskMarginPx, box.y - kMaskMarginPx, box.width + 2 * kMaskMarginPx,
                       box.height + 2 * kMaskMarginPx);
  cv::Mat part = region(grown & cv::Rect({}, size));
  if (!part.empty()) {
    cv::dilate(
        part, part,
        cv::getStructuringElement(cv::MORPH_RECT, {2 * kMaskMarginPx + 1, 2 * kMaskMarginPx + 1}));
  }
  return region;
}

}  // namespace hullslam
