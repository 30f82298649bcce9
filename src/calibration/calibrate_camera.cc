// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibrate_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hullslam {
namespace {

// The parameters that the recording determines.
std::vector<CameraParameter> Determined(const CameraEvidence& evidence) {
  std::vector<CameraParameter> determined;
  for (const ParameterEvidence& one : evidence.parameters) {
    if (one.parameter.IsNuisance() ||
        (one.parameter.IsCoefficient() ? evidence.IsDistortionDetermined() : one.IsDetermined())) {
      determined.push_back(one.parameter);
    }
  }
  return determined;
}

}  // namespace

bool CameraCalibrationResult::IsCalibrated(const std::string& name) const {
  return std::ranges::find(calibrated, name) != calibrated.end();
}

CameraCalibrationResult CalibrateCamera(const CalibrationProblem& problem, const CameraModel& given,
                                        const CalibrationChoice& choice, double slack) {
  CameraAdjustment fixed(problem, given, {});
  fixed.Solve({});
  std::vector<CameraParameter> parameters =
      ParametersOf(given, choice, problem.has_depth, MedianSpeed(problem, given));
  CameraAdjustment free(fixed.problem(), given, parameters);
  free.Solve({});
  CameraCalibrationResult result{.given = given,
                                 .model = given,
                                 .evidence = MeasureEvidence(free, slack),
                                 .calibrated = {},
                                 .median_error_before = fixed.MedianError()};
  // What is not determined is held, so that the rest may become determined or not. Two rounds
  // settle it.
  CameraEvidence evidence = result.evidence;
  for (int round = 0; round < 2; ++round) {
    std::vector<CameraParameter> kept = Determined(evidence);
    if (kept.size() == parameters.size()) {
      break;
    }
    parameters = std::move(kept);
    free = CameraAdjustment(fixed.problem(), given, parameters);
    free.Solve({});
    if (parameters.empty()) {
      break;
    }
    evidence = MeasureEvidence(free, slack);
  }
  // The metre of a depth camera is its depth's, and the size of a motion is depth over f. So a new
  // f with the old scale of depth would change lengths, and f is kept where it is as right as the
  // scale is known.
  const double change = std::log(free.model().camera.fx / given.camera.fx);
  const bool is_metric = problem.has_depth && !given.is_pair;
  if (is_metric && slack == 1.0 && std::abs(change) < 2.0 * kDepthScaleSigma) {
    const auto dropped = std::erase_if(parameters, [](const CameraParameter& parameter) {
      return parameter.kind == CameraParameter::Kind::kFocalLength;
    });
    if (dropped > 0) {
      free = CameraAdjustment(fixed.problem(), given, parameters);
      free.Solve({});
      evidence = MeasureEvidence(free, slack);
    }
  }
  result.median_error = free.MedianError();
  std::erase_if(result.evidence.parameters,
                [](const ParameterEvidence& one) { return one.parameter.IsNuisance(); });
  const double factor = evidence.jackknife_factor;
  result.evidence_ratio =
      2.0 * (fixed.cost() - free.cost()) / (free.VarianceFactor() * factor * factor);
  for (const CameraParameter& parameter : parameters) {
    if (parameter.IsNuisance()) {
      continue;
    }
    result.calibrated.push_back(parameter.name);
    for (ParameterEvidence& one : result.evidence.parameters) {
      if (const ParameterEvidence* const held = evidence.Find(one.parameter.name);
          held != nullptr && one.parameter.name == parameter.name) {
        one = *held;
      }
    }
  }
  // 4 sigmas for as many numbers: a right camera is practically never changed.
  const auto numbers = static_cast<double>(parameters.size());
  result.is_changed = result.evidence_ratio > numbers + 4.0 * std::sqrt(2.0 * numbers);
  if (result.is_changed) {
    result.model = free.model();
    result.model.depth_scale = given.depth_scale;
  }
  return result;
}

}  // namespace hullslam
