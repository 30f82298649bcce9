// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "calibration/camera_problem.h"
#include "calibration/determined.h"

namespace hullslam {

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
