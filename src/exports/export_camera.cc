// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "camera/named_lens.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// The whole pixels between the undistorted borders of the raw image. A border is curved; the
// innermost point of each counts.
cv::Rect SeenRectangle(const PinholeCamera& camera) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double right = camera.width - 1.0;
  const double bottom = camera.height - 1.0;
  double min_x = -kInfinity;
  double min_y = -kInfinity;
  double max_x = kInfinity;
  double max_y = kInfinity;
  for (int y = 0; y < camera.height; ++y) {
    min_x = std::max(min_x, camera.Undistort({0.0, y}).x());
    max_x = std::min(max_x, camera.Undistort({right, y}).x());
  }
  for (int x = 0; x < camera.width; ++x) {
    min_y = std::max(min_y, camera.Undistort({x, 0.0}).y());
    max_y = std::min(max_y, camera.Undistort({x, bottom}).y());
  }
  const auto corner = [](double x, double y) {
    return cv::Point(static_cast<int>(x), static_cast<int>(y));
  };
  const cv::Point first = corner(std::ceil(min_x), std::ceil(min_y));
  const cv::Point last = corner(std::floor(max_x), std::floor(max_y));
  return {first, last + cv::Point(1, 1)};
}

}  // namespace

ExportCamera::ExportCamera(const PinholeCamera& camera) : camera_(camera) {
  if (!camera.IsDistorted()) {
    return;
  }
  const cv::Rect seen = SeenRectangle(camera);
  if (seen.empty()) {
    throw InputError("the camera has too much distortion for an undistorted image");
  }
  offset_ = {seen.x, seen.y};
  SetNamedLens("pinhole", {}, camera_);
  camera_.cx -= seen.x;
  camera_.cy -= seen.y;
  camera_.width = seen.width;
  camera_.height = seen.height;
  raw_x_.create(seen.size(), CV_32FC1);
  raw_y_.create(seen.size(), CV_32FC1);
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      const Eigen::Vector2d raw = camera.Distort(Eigen::Vector2d(x, y) + offset_);
      raw_x_.at<float>(y, x) = static_cast<float>(raw.x());
      raw_y_.at<float>(y, x) = static_cast<float>(raw.y());
    }
  }
}

bool ExportCamera::Contains(const Eigen::Vector2d& pixel) const {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera_.width - 0.5 &&
         pixel.y() < camera_.height - 0.5;
}

cv::Mat ExportCamera::Undistort(const cv::Mat& raw, int interpolation) const {
  if (raw_x_.empty()) {
    return raw;
  }
  cv::Mat image;
  cv::remap(raw, image, raw_x_, raw_y_, interpolation, cv::BORDER_REPLICATE);
  return image;
}

}  // namespace hullslam
