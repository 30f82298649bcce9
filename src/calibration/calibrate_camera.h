// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
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

struct CameraCalibrationOptions {
  CalibrationChoice choice = {};
  // If nothing but a guess is known of the camera, all numbers are calibrated, also uncertain ones,
  // near this guess (ExpectNear).
  std::optional<CameraModel> guess = {};
  // The focal length that the user gave, px; 0: none. That of a depth camera is kept if it is right
  // within two standard deviations of the scale of depth (kDepthScaleSigma): the metre of such a
  // camera is its depth's, and the size of a motion is depth over f, so a new f with the old scale
  // of depth would change lengths.
  double trusted_focal_length = 0.0;
};

// Calibrates the numbers of a camera that the problem determines, with all poses and points. The
// others keep their values. The coefficients of the lens are taken together, because none of them
// is known alone.
CameraCalibrationResult CalibrateCamera(const CalibrationProblem& problem, const CameraModel& given,
                                        const CameraCalibrationOptions& options);

}  // namespace hullslam
