// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "calibration/camera_problem.h"
#include "calibration/determined.h"

namespace hullslam {

// The result of a calibration.
struct CameraCalibrationResult {
  CameraModel given;
  CameraModel model;  // calibrated where the recording determines it
  // What the recording tells about every number.
  CameraEvidence evidence;
  // The names of the numbers that were calibrated.
  std::vector<std::string> calibrated;
  double median_error_before = 0.0;  // px, with the given camera
  double median_error = 0.0;
  // Twice the decrease of the cost by the calibrated numbers, over the variance of the residuals
  // and the square of the jackknife's factor: a chi-square variable if the given camera is right.
  double evidence_ratio = 0.0;
  // Whether the given camera contradicts the recording. Else `model` is the given one.
  bool is_changed = false;

  bool IsCalibrated(const std::string& name) const;
};

// Calibrates the numbers of a camera that the problem determines, with all poses and points. The
// others keep their values. The coefficients of the lens are taken together, because none of them
// is known alone. The focal length of a depth camera is kept if it is right within two standard
// deviations of the scale of depth (kDepthScaleSigma). The bounds of what counts as determined are
// multiplied by `slack`: if nothing is known of the given camera, also an uncertain number is
// better.
CameraCalibrationResult CalibrateCamera(const CalibrationProblem& problem, const CameraModel& given,
                                        const CalibrationChoice& choice, double slack = 1.0);

}  // namespace hullslam
