// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "calibration/camera_model.h"

namespace hullslam {

// A view of a point.
struct CalibrationObservation {
  uint32_t view = 0;
  Eigen::Vector2d raw = Eigen::Vector2d::Zero();  // px
  double sigma = 1.0;                             // of raw, px
  double disparity = 0.0;                         // measured, bf / z, px; 0 if unknown
  // The change of the measured disparity per undistorted pixel to the right and down, px/px: that
  // of the surface.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double depth_delay = 0.0;  // s, as in Frame
};

// The residual of a point x of the camera frame at the exposure of the middle of the image, in
// standard deviations, three numbers:
//   (Distort(Project(y)) - raw) / sigma   and   (bf / (s y_z) + o - disparity) / disparity_sigma,
// where y is x at the exposure of the measured raw pixel (MovedPoint), s is
// CameraModel::depth_scale and o is CameraModel::disparity_offset. The last one is 0 without a
// disparity. If depth was taken later or from elsewhere, y in it is the point d at that time and
// seen from there, and it shows a neighbour of the point at the raw pixel, so that the slope times
// (Project(y) - Project(d)) is added to its disparity. Infinite for a point that
// is not in front of the camera.
struct RawResidual {
  double disparity_sigma = 1.0;  // px
  // As in CalibrationProblem. The poses are small, so they add up.
  Eigen::Matrix<double, 6, 1> known_depth_pose = Eigen::Matrix<double, 6, 1>::Zero();

  Eigen::Vector3d At(const CameraModel& model, const PointVelocity& velocity,
                     const CalibrationObservation& seen, const Eigen::Vector3d& point) const;
  // The derivative by the point.
  Eigen::Matrix3d ByPoint(const CameraModel& model, const PointVelocity& velocity,
                          const CalibrationObservation& seen, const Eigen::Vector3d& point) const;
};

// The derivatives of residuals by numbers of the camera, in steps, by central differences: a lens
// may have any coefficients.
class ByCameraParameters {
 public:
  ByCameraParameters(const CameraModel& model, std::span<const CameraParameter> parameters);

  Eigen::Matrix<double, 3, Eigen::Dynamic> Of(const RawResidual& residual,
                                              const PointVelocity& velocity,
                                              const CalibrationObservation& seen,
                                              const Eigen::Vector3d& point) const;

 private:
  std::vector<CameraModel> below_;
  std::vector<CameraModel> above_;
};

}  // namespace hullslam
