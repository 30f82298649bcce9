// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "frame/rolling_shutter.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// Everything about a camera that can be calibrated.
struct CameraModel {
  PinholeCamera camera;
  double readout_time = 0.0;  // s, as in Sensor
  ReadoutDirection readout_direction = ReadoutDirection::kRows;
  // The measured disparity bf / z minus the true one, px. It models a depth camera whose depths are
  // too short or too long by a share that grows with the depth, and a pair whose principal points
  // differ.
  double disparity_offset = 0.0;
  // The measured depth over the true one. No recording tells it, because a larger world with a
  // larger motion looks the same. But it is not known better than kDepthScaleSigma, and a depth
  // camera determines the focal length only as well as its scale is known.
  double depth_scale = 1.0;
  // Whether bf is the baseline of a real pair, so that it grows with the focal length. That of a
  // depth camera is only the unit of its disparities.
  bool is_pair = false;
  // When and where depth images were taken, beside what their time stamps and their registration to
  // the colour image say: so many seconds after the colour image, and by the pose
  // depth_from_colour, a rotation vector (rad) and a translation (m).
  double depth_time = 0.0;
  Eigen::Matrix<double, 6, 1> depth_pose = Eigen::Matrix<double, 6, 1>::Zero();

  // Seconds between the exposure of the middle of the image and that of a raw pixel.
  double ExposureOf(const Eigen::Vector2d& raw) const;
  // The raw pixel at which a point (camera frame at the exposure of the middle) is seen, if it is
  // exposed `seconds` after the middle and moves with this velocity.
  Eigen::Vector2d Project(const Eigen::Vector3d& point, const PointVelocity& velocity,
                          double seconds) const;
};

// A point that moves with a constant velocity of the camera, after so many seconds; up to the
// second order of the rotation, whose third is below 0.001 px for hand-held cameras.
Eigen::Vector3d MovedPoint(const Eigen::Vector3d& point, const PointVelocity& velocity,
                           double seconds);

// The standard deviation of the scale of depth images, as a share; those of structured light differ
// by about this much from camera to camera.
inline constexpr double kDepthScaleSigma = 0.01;

inline constexpr const char* kDepthScaleName = "depth_scale";

// One number of a CameraModel.
struct CameraParameter {
  enum class Kind {
    kFocalLength,
    kField,
    kReadout,
    kDisparityOffset,
    kDepthScale,
    kDepthTime,
    kDepthPose
  };
  Kind kind = Kind::kField;
  double PinholeCamera::*field = nullptr;  // of kField
  int index = 0;                           // of kDepthPose
  std::string name;                        // of the setting, without "Camera."
  std::string unit;                        // "px", "s" or ""
  // The change of the number that moves pixels at the border of the image by about 1 px. All
  // mathematics uses multiples of it.
  double step = 1.0;
  // What is known of it before: a normal distribution with this standard deviation, in steps. 0:
  // nothing.
  double prior_steps = 0.0;
  double expected = 0.0;

  bool IsFocalLength() const { return kind == Kind::kFocalLength; }
  // Whether the number is only there because it is not known exactly (CameraModel::depth_scale).
  bool IsNuisance() const { return kind == Kind::kDepthScale; }
  // Whether it says where the axis of the lens is: the principal point and Brown's tangential
  // distortion, which replace one another where the camera hardly turns.
  bool IsCentring() const {
    return field == &PinholeCamera::cx || field == &PinholeCamera::cy ||
           field == &PinholeCamera::p1 || field == &PinholeCamera::p2;
  }
  bool IsCoefficient() const { return kind == Kind::kField && unit.empty(); }  // of the lens
  double ValueIn(const CameraModel& model) const;
  // How far the number is from what is known before, in standard deviations; 0 if nothing is.
  double DeviationIn(const CameraModel& model) const;
  // Changes the number by so many steps.
  void Move(double steps, CameraModel& model) const;
};

// Which numbers are calibrated.
struct CalibrationChoice {
  bool focal_length = true;  // fx and fy, which keep their ratio
  bool principal_point = true;
  bool distortion = true;
  bool readout = true;
  bool disparity = true;   // only with depth
  bool depth_pose = true;  // of depth images, with their time
};

// The parameters of a camera. With Brown's lens, k1, k2, p1 and p2, and the others that are not 0;
// with a wide lens, all of its coefficients. `speed` is that of pixels in the image, px/s, a
// median.
std::vector<CameraParameter> ParametersOf(const CameraModel& model, const CalibrationChoice& choice,
                                          bool has_depth, double speed);
// Sets what is known of a camera that is only guessed: f within 25 %, the principal point within
// 2 % of the width of the image, lenses that move its border by less than 60 px, by 3 px if they
// are Brown's tangential coefficients, 60 ms of readout, and 2 px of disparity.
void ExpectNear(const CameraModel& guess, std::vector<CameraParameter>& parameters);

}  // namespace hullslam
