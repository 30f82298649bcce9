// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <span>
#include <string>

#include "hullslam/util/option_table.h"

namespace hullslam {

// The models of a lens. All map a direction to a point of the plane z = 1, and the intrinsics map
// this point to a raw pixel.
enum class LensModel {
  // Brown's model in the rational form of OpenCV: radial factor (1 + k1 r^2 + k2 r^4 + k3 r^6) /
  // (1 + k4 r^2 + k5 r^4 + k6 r^6), tangential p1 and p2.
  kBrown,
  // Fisheye (Kannala and Brandt 2006): a ray at the angle t from the axis is seen at the radius
  // t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8). It is OpenCV's `fisheye`, the `equidistant` of
  // Kalibr and ROS, and ORB-SLAM3's KannalaBrandt8.
  kKannalaBrandt,
  // Double sphere (Usenko et al. 2018) with xi and alpha: the `ds` of Kalibr and Basalt, whose
  // focal lengths are 1 + xi times as large: here they are those on the axis.
  kDoubleSphere,
  // The extended unified model (Khomutenko et al. 2016) with alpha and beta: the `eucm` of Kalibr
  // and Basalt.
  kExtendedUnified,
};

// Pinhole camera with the lens through which its raw images were taken. For RGB-D it also has the
// baseline of the virtual stereo pair. All SLAM mathematics projects to undistorted pixels with the
// same intrinsics. Undistortion stretches the image, most of all at the rim of a wide lens, so
// errors, windows and distances are measured in raw pixels, for every lens: an undistorted offset
// times DistortionJacobian() is a raw one.
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
  double k4 = 0.0;
  double k5 = 0.0;
  double k6 = 0.0;
  LensModel lens = LensModel::kBrown;
  double xi = 0.0;  // of kDoubleSphere
  double alpha = 0.0;
  double beta = 1.0;  // of kExtendedUnified

  // Radians. Rays farther from the axis of a fisheye lens are not used, because their undistorted
  // pixels run to infinity at 90 degrees. There, an error of d radians in the ray deviates from its
  // linear form by the share d tan(angle): 8 % at this angle for 3.6 px, three sigmas of a keypoint
  // of a middle level, in a lens of 250 px per radian.
  static constexpr double kMostAngle = 80.0 * std::numbers::pi / 180.0;

  bool operator==(const PinholeCamera&) const = default;

  // Binds the fields to ORB-SLAM2's keys `Camera.fx` and so on.
  void Bind(OptionTable& options);

  // Calibration matrix: upper triangular, px.
  Eigen::Matrix3d Matrix() const {
    return (Eigen::Matrix3d() << fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0).finished();
  }

  bool IsFisheye() const { return lens != LensModel::kBrown; }
  // Whether parts of the raw image are beyond kMostAngle.
  bool IsWide() const;
  bool IsDistorted() const;

  // Undistorted pixel of a point in the camera frame (metres, z forward). Requires z > 0.
  Eigen::Vector2d Project(const Eigen::Vector3d& point_in_cam) const {
    const double inverse_z = 1.0 / point_in_cam.z();
    return {fx * point_in_cam.x() * inverse_z + cx, fy * point_in_cam.y() * inverse_z + cy};
  }
  // Point in the camera frame that is seen at an undistorted pixel, at `depth` metres along z.
  Eigen::Vector3d Unproject(const Eigen::Vector2d& pixel, double depth) const {
    return {(pixel.x() - cx) / fx * depth, (pixel.y() - cy) / fy * depth, depth};
  }

  // Raw pixel of an undistorted pixel.
  Eigen::Vector2d Distort(const Eigen::Vector2d& undistorted) const;
  // Derivative of Distort().
  Eigen::Matrix2d DistortionJacobian(const Eigen::Vector2d& undistorted) const;
  // Undistorted pixel of a raw pixel, by Newton's method on Distort(). The residual is below 1e-6
  // px inside the image for the cameras in config/. Where the distortion polynomial has no inverse
  // because it folds, the best point found is returned. Raw pixels of a fisheye lens beyond
  // kMostAngle give the pixel at this angle.
  Eigen::Vector2d Undistort(const Eigen::Vector2d& raw) const;
  // Whether a raw pixel is inside the image and, with a fisheye lens, within kMostAngle.
  bool SeesRaw(const Eigen::Vector2d& raw) const;
  // The radius around the principal point, px, at which the distortion of the raw image folds: two
  // directions have the same pixel beyond. Infinite if it does not.
  double FoldRadius() const;

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
  Bounds RawBounds() const {
    return {.max_x = static_cast<double>(width), .max_y = static_cast<double>(height)};
  }

  // The reason why this cannot be the camera of a real image, with its key: a number that is not
  // finite or out of range, a distortion that has no inverse at a pixel of the image, or an
  // undistorted image of a very different size. Empty if there is nothing wrong.
  std::string FindFault() const;
};

}  // namespace hullslam
