// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/detection.h"

namespace hullslam {

// The pinhole image in which the lines of a mask are made. It is the undistorted image, except with
// a fisheye lens, whose undistorted image is stretched towards the rim: there it is the image of a
// pinhole that looks at the mask, with as many px per radian as the raw image has there. A line of
// one such image is a line of the other, since both are planes through the camera's centre, but a
// tolerance in px means the same everywhere only in the image that looks at the mask.
class MaskCamera {
 public:
  // The undistorted image.
  MaskCamera(const PinholeCamera& camera);  // NOLINT(google-explicit-constructor)
  // The view of a mask with these outlines (raw px).
  MaskCamera(const PinholeCamera& camera, std::span<const std::vector<Eigen::Vector2d>> outlines);

  double focal() const { return focal_; }  // px
  const PinholeCamera& camera() const { return camera_; }

  // Between pixels of the view and raw pixels. Raw pixels that are not used (SeesRaw) give the
  // nearest pixel that is.
  Eigen::Vector2d Undistort(const Eigen::Vector2d& raw) const;
  Eigen::Vector2d Distort(const Eigen::Vector2d& pixel) const;
  // The distance of a point (camera frame, m) along the axis of the view.
  double DepthOf(const Eigen::Vector3d& point) const {
    return is_turned_ ? view_from_cam_.row(2).dot(point) : point.z();
  }
  // Whether a pixel of the view is less than `border` raw px from the border of what is used.
  bool IsAtBorder(const Eigen::Vector2d& pixel, double border) const;

  // Takes a detection from the view to the undistorted image.
  void ToUndistorted(Detection& detection) const;

 private:
  Eigen::Vector3d RayOf(const Eigen::Vector2d& pixel) const;  // camera frame

  PinholeCamera camera_;
  bool is_turned_ = false;
  Eigen::Matrix3d view_from_cam_ = Eigen::Matrix3d::Identity();
  double focal_ = 0.0;
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();  // principal point of a turned view
};

}  // namespace hullslam
