// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/mask_registration.h"

#include <algorithm>
#include <cmath>

#include "eval/relative_gradient.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr int kOrientations = 8;

// The position in the stored image, in shares of its size, of (u, v) in the turned image.
Eigen::Vector2d StoredPosition(int orientation, double u, double v) {
  switch (orientation) {
    case 2:
      return {1.0 - u, v};
    case 3:
      return {1.0 - u, 1.0 - v};
    case 4:
      return {u, 1.0 - v};
    case 5:
      return {v, u};
    case 6:
      return {v, 1.0 - u};
    case 7:
      return {1.0 - v, 1.0 - u};
    case 8:
      return {1.0 - v, u};
    default:
      return {u, v};
  }
}

}  // namespace

void MaskRegistration::Add(const cv::Mat& grey, std::span<const InstanceMask> masks) {
  Check(grey.type() == CV_8UC1, "the image is not grey");
  const cv::Mat gradient = RelativeGradient(grey);
  const auto add_point = [&](const Eigen::Vector2d& point) {
    const double u = (point.x() + 0.5) / grey.cols;
    const double v = (point.y() + 0.5) / grey.rows;
    for (int orientation = 1; orientation <= kOrientations; ++orientation) {
      const Eigen::Vector2d place = StoredPosition(orientation, u, v);
      const int x = std::clamp(static_cast<int>(place.x() * grey.cols), 0, grey.cols - 1);
      const int y = std::clamp(static_cast<int>(place.y() * grey.rows), 0, grey.rows - 1);
      gradients_[static_cast<size_t>(orientation)] += gradient.at<float>(y, x);
    }
    ++points_;
  };
  for (const InstanceMask& mask : masks) {
    if (mask.shape != MaskShape::kContour || mask.outlines.empty()) {
      continue;
    }
    const std::vector<Eigen::Vector2d>& outline = mask.outlines.front();
    for (size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d step = outline[(i + 1) % outline.size()] - outline[i];
      const int count = std::max(1, static_cast<int>(step.norm()));
      for (int k = 0; k < count; ++k) {
        add_point(outline[i] + step * k / count);
      }
    }
  }
}

double MaskRegistration::Contrast(int orientation) const {
  Check(points_ > 0, "there are no contours");
  Check(orientation >= 1 && orientation <= kOrientations, "not an orientation of EXIF");
  return gradients_[static_cast<size_t>(orientation)] / static_cast<double>(points_);
}

}  // namespace hullslam
