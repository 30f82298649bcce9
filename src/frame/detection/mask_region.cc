// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/mask_region.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace hullslam {
namespace {

// px. Far outside any image, but OpenCV's fixed-point arithmetic does not overflow there.
constexpr double kFar = 32000.0;

std::vector<cv::Point> Rounded(std::span<const Eigen::Vector2d> outline) {
  std::vector<cv::Point> points;
  points.reserve(outline.size());
  for (const Eigen::Vector2d& p : outline) {
    points.emplace_back(cvRound(std::clamp(p.x(), -kFar, kFar)),
                        cvRound(std::clamp(p.y(), -kFar, kFar)));
  }
  return points;
}

}  // namespace

MaskRegion::MaskRegion(std::span<const std::vector<Eigen::Vector2d>> outlines,
                       const PinholeCamera& camera) {
  std::vector<std::vector<cv::Point>> parts;
  for (const std::vector<Eigen::Vector2d>& outline : outlines) {
    parts.push_back(Rounded(outline));
    box_ = box_ | cv::boundingRect(parts.back());
  }
  box_ = box_ & cv::Rect(0, 0, camera.width, camera.height);
  if (box_.empty()) {
    box_ = {};
    return;
  }
  pixels_ = cv::Mat::zeros(box_.size(), CV_8UC1);
  // Each part is filled by itself, because cv::fillPoly would leave holes where parts overlap.
  for (const std::vector<cv::Point>& part : parts) {
    cv::fillPoly(pixels_, part, cv::Scalar(255), cv::LINE_8, 0, -box_.tl());
  }
  area_ = cv::countNonZero(pixels_);
}

bool MaskRegion::ContainsAround(const Eigen::Vector2d& raw, double margin) const {
  const double diagonal = margin / std::numbers::sqrt2;
  const auto holds = [&](double dx, double dy) { return Contains(raw + Eigen::Vector2d(dx, dy)); };
  return holds(0.0, 0.0) && holds(margin, 0.0) && holds(-margin, 0.0) && holds(0.0, margin) &&
         holds(0.0, -margin) && holds(diagonal, diagonal) && holds(diagonal, -diagonal) &&
         holds(-diagonal, diagonal) && holds(-diagonal, -diagonal);
}

int SharedArea(const MaskRegion& a, const MaskRegion& b) {
  const cv::Rect shared = a.box_ & b.box_;
  if (shared.empty()) {
    return 0;
  }
  cv::Mat both;
  cv::bitwise_and(a.pixels_(shared - a.box_.tl()), b.pixels_(shared - b.box_.tl()), both);
  return cv::countNonZero(both);
}

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
