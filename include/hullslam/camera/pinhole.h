// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "hullslam/util/option_table.h"

namespace hullslam {

// Pinhole camera with Brown distortion (k1 k2 p1 p2 k3, in the order of OpenCV). For RGB-D it also
// has the baseline of the virtual stereo pair. All SLAM mathematics uses undistorted pixels with
// the same intrinsics; raw pixels appear only where images are read.
struct PinholeCamera {
  double fx = 0.0;  // px
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
  int width = 640;  // px
  int height = 480;
  double bf = 40.0;  // baseline (m) times fx (px)

  bool operator==(const PinholeCamera&) const = default;

  // Binds the fields to ORB-SLAM2's keys `Camera.fx` and so on.
  void Bind(OptionTable& options);

  // Calibration matrix: upper triangular, px.
  Eigen::Matrix3d Matrix() const {
    return (Eigen::Matrix3d() << fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0).finished();
  }

  bool IsDistorted() const { return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0; }

  // Undistorted pixel of a point in the camera frame (metres, z forward). Requires z > 0.
  Eigen::Vector2d Project(const Eigen::Vector3d& point_in_cam) const {
    const double inverse_z = 1.0 / point_in_cam.z();
    return {fx * point_in_cam.x() * inverse_z + cx, fy * point_in_cam.y() * inverse_z + cy};
  }
  // Point in the camera frame that is seen at an undistorted pixel, at `depth` metres along z.
  Eigen::Vector3d Unproject(const Eigen::Vector2d& pixel, double depth) const {
    return {(pixel.x() - cx) / fx * depth, (pixel.y() - cy) / fy * depth, depth};
  }

  // Raw pixel of an undistorted pixel (Brown 1971).
  Eigen::Vector2d Distort(const Eigen::Vector2d& undistorted) const;
  // Undistorted pixel of a raw pixel, by Newton's method on Distort(). The residual is below 1e-6
  // px inside the image for the cameras in config/. Where the distortion polynomial has no inverse
  // because it folds, the best point found is returned.
  Eigen::Vector2d Undistort(const Eigen::Vector2d& raw) const;

  // Smallest axis-aligned box that contains the undistorted image.
  struct Bounds {
    double min_x = 0.0;
    double min_y = 0.0;
    double max_x = 0.0;
    double max_y = 0.0;
    bool Contains(const Eigen::Vector2d& pixel) const {
      return pixel.x() >= min_x && pixel.x() < max_x && pixel.y() >= min_y && pixel.y() < max_y;
    }
  };
  Bounds UndistortedBounds() const;

  // The reason why this cannot be the camera of a real image, with its key: a number that is not
  // finite or out of range, a distortion that has no inverse at a pixel of the image, or an
  // undistorted image of a very different size. Empty if there is nothing wrong.
  std::string FindFault() const;
};

}  // namespace hullslam
