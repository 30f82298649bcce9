// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// A rigid pair of cameras, as it was calibrated. PinholeCamera::bf is not used.
struct StereoCalibration {
  PinholeCamera left;
  PinholeCamera right;
  Rigid3 right_from_left;  // m
};

// Turns the images of a pair so that a point lies in the same row of both (Bouguet's method, by
// OpenCV). The rectified images have the size of the images as read.
class StereoRectifier {
 public:
  // Throws InputError that begins with `origin` for a pair that cannot be rectified: a camera with
  // a fault (PinholeCamera::FindFault), sizes that differ, no baseline, one that is not horizontal,
  // or a right camera that is left of the other.
  StereoRectifier(const StereoCalibration& calibration, const std::string& origin);

  // The camera of the rectified left image, without distortion. bf is the baseline times fx.
  const PinholeCamera& camera() const { return camera_; }
  // The left camera as read has the same centre as the rectified one but another rotation.
  const Rigid3& rectified_from_left() const { return left_.rectified_from_read; }
  const Rigid3& rectified_from_right() const { return right_.rectified_from_read; }
  const StereoCalibration& calibration() const { return calibration_; }
  // Whether the images stay as they are.
  bool IsIdentity() const { return left_.maps.columns.empty(); }

  // The images as read must have the size of the cameras. Those of a pair that is rectified already
  // are returned as they are.
  cv::Mat Rectify(const cv::Mat& image, ImageSide side) const;
  // The pixel of the rectified image that shows what this pixel of the image as read shows.
  Eigen::Vector2d Rectify(const Eigen::Vector2d& pixel, ImageSide side) const;

 private:
  struct Maps {
    cv::Mat columns;  // empty: the image stays as it is
    cv::Mat rows;
  };
  static Maps MakeMaps(const PinholeCamera& read, const Eigen::Matrix3d& rotation,
                       const PinholeCamera& rectified);
  // One camera of the pair.
  struct Eye {
    PinholeCamera read;
    Rigid3 rectified_from_read = {};
    Maps maps = {};
  };
  void Turn(const Eigen::Matrix3d& rotation, Eye& eye) const;
  const Eye& EyeOf(ImageSide side) const { return side == ImageSide::kLeft ? left_ : right_; }

  StereoCalibration calibration_;
  Eye left_;
  Eye right_;
  PinholeCamera camera_;
};

}  // namespace hullslam
