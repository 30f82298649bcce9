// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// Images without distortion for programs that only know pinhole cameras. The focal lengths are
// as in the camera, so images are neither enlarged nor reduced. The image is the largest
// rectangle that all four borders of the raw image allow, so every pixel of it was seen.
class ExportCamera {
 public:
  // Throws InputError if there is no such rectangle, because the distortion is too strong.
  explicit ExportCamera(const PinholeCamera& camera);

  // Without distortion, with the size and the principal point of the images of this view. Like
  // everywhere in HullSLAM, the centre of the first pixel is (0, 0).
  const PinholeCamera& camera() const { return camera_; }
  // The pixel of this view that has these undistorted pixel coordinates of the raw camera.
  Eigen::Vector2d FromUndistorted(const Eigen::Vector2d& pixel) const { return pixel - offset_; }
  // Whether a pixel of this view is inside of its image.
  bool Contains(const Eigen::Vector2d& pixel) const;

  // The image of this view, from a raw image of the camera. `interpolation` is as in cv::remap.
  cv::Mat Undistort(const cv::Mat& raw, int interpolation) const;

 private:
  PinholeCamera camera_;
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();  // undistorted px of the first pixel
  cv::Mat raw_x_;                                     // CV_32FC1, the raw px of each pixel
  cv::Mat raw_y_;
};

}  // namespace hullslam
