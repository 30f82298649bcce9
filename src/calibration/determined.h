// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "calibration/camera_problem.h"

namespace hullslam {

// What a recording tells about one number of a camera.
struct ParameterEvidence {
  CameraParameter parameter;
  double value = 0.0;
  double sigma = 0.0;         // of the value, by the jackknife
  double bundle_sigma = 0.0;  // of the value, if all errors were independent
  // The other number whose error goes with that of this one most, and the correlation, -1 to 1.
  std::string partner;
  double correlation = 0.0;
  double bound = 0.0;  // on sigma, up to which the number counts as determined
  bool IsDetermined() const { return sigma <= bound; }
};

// What a recording tells about a camera.
struct CameraEvidence {
  std::vector<ParameterEvidence> parameters;
  // The standard deviation of the position of a pixel near a corner of the image by the errors of
  // all coefficients of the lens together, px. They go with one another, so none of them is known
  // as well as this. Negative without coefficients.
  double distortion_sigma = -1.0;
  bool IsDistortionDetermined() const;
  bool IsCentringDetermined() const;  // both numbers of the principal point
  // Whether all numbers of the pose of depth images are determined, and the axis of the lens: where
  // the axis is wrong, another pose makes up for most of it.
  bool IsDepthPoseDetermined() const;
  // How much larger errors are than those of a bundle adjustment whose errors are independent.
  double jackknife_factor = 1.0;
  // Whether pieces of the recording contradict each other, far beyond what neighbouring errors
  // explain (factors of 1.4 to 5.6 are usual): no single camera fits, or the map is wrong.
  bool IsContradictory() const { return jackknife_factor > 8.0; }
  double variance_factor = 1.0;  // CameraAdjustment::Minimum

  const ParameterEvidence* Find(const std::string& name) const;
};

// The adjustment must be at its minimum. The covariance of a bundle adjustment is too small,
// because errors of neighbouring images go together. So each of ten pieces of the recording is left
// out in turn: the jackknife's variance is 9 / 10 of the sum of the squared deviations of the ten
// estimates (Efron 1982).
CameraEvidence MeasureEvidence(const CameraAdjustment& adjustment);

// What the camera did in a recording.
struct MotionSummary {
  double turn_across = 0.0;  // rad; the largest angle between two optical axes
  double roll = 0.0;         // rad; the largest rotation about the optical axis
  double way = 0.0;          // the largest distance of two views over the median depth of points
  double way_ahead = 0.0;    // the part of `way` along the optical axis
  // The largest share of the points in one plane, 0 to 1.
  double plane = 0.0;
};
MotionSummary SummarizeMotion(const CalibrationProblem& problem);

// Why a number is not determined, and which motion would help: one sentence.
std::string AdviceFor(const ParameterEvidence& parameter, const MotionSummary& motion);

}  // namespace hullslam
