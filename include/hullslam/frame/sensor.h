// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

enum class SensorKind {
  kRgbd,
  // A monocular camera. The unit of length of its map is not known in metres; it is the median
  // depth of the first points.
  kMonocular,
  // Two synchronised cameras. The images are rectified; the camera is the left one.
  kStereo,
};

// Whether a rolling shutter exposes an image row after row or column after column.
enum class ReadoutDirection { kRows, kColumns };

// The properties of the camera that are the same for all frames of a run.
struct Sensor {
  SensorKind kind = SensorKind::kRgbd;
  PinholeCamera camera;
  PinholeCamera::Bounds bounds;  // bounds of the undistorted image, px
  ScaleLevels levels;
  double close_depth = 0.0;  // m; smaller depths are precise enough for a landmark from one view
  DepthErrorOptions depth_error;
  double frames_per_second = 30.0;
  // Time from the exposure of the top row of an image to that of the bottom row, or from the left
  // column to the right one, s. Negative if the bottom row or the right column is exposed first; 0
  // for a global shutter, which exposes the whole image at the same time.
  double readout_time = 0.0;
  ReadoutDirection readout_direction = ReadoutDirection::kRows;
  // Depth images are taken so much later than their stamps say, s (DepthOptions).
  double depth_time = 0.0;
  // One mask for all images, such as that of the robot's own arm, and one for all right images of a
  // stereo camera. Each is CV_8UC1 of the size of the raw image, 0 at pixels that are ignored;
  // empty if all pixels are used.
  cv::Mat mask_all;
  cv::Mat mask_all_right;

  // The raw pixel of an undistorted one. Null if it is outside of the image or is not used.
  std::optional<Eigen::Vector2d> RawPixel(const Eigen::Vector2d& pixel) const {
    if (!bounds.Contains(pixel)) {
      return std::nullopt;
    }
    const Eigen::Vector2d raw = camera.Distort(pixel);
    return camera.SeesRaw(raw) && !IsIgnored(raw) ? std::optional(raw) : std::nullopt;
  }
  bool Sees(const Eigen::Vector2d& pixel) const { return RawPixel(pixel).has_value(); }
  // Whether `mask_all` ignores a raw pixel of the image.
  bool IsIgnored(const Eigen::Vector2d& raw) const {
    const auto x = static_cast<int>(std::lround(raw.x()));
    const auto y = static_cast<int>(std::lround(raw.y()));
    return x >= 0 && y >= 0 && x < mask_all.cols && y < mask_all.rows &&
           mask_all.at<unsigned char>(y, x) == 0;
  }

  // Whether an image and its depths are not all of one time.
  bool HasSeveralTimes() const { return readout_time != 0.0 || depth_time != 0.0; }
  bool IsStereo() const { return kind == SensorKind::kStereo; }
  bool IsMonocular() const { return kind == SensorKind::kMonocular; }
  // Baseline of the stereo pair, for RGB-D a virtual one, m; 0 for a monocular camera.
  double baseline() const { return IsMonocular() ? 0.0 : camera.bf / camera.fx; }
};

}  // namespace hullslam
