// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibrate_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hullslam {
namespace {

// The parameters that the recording determines. What belongs together is taken as a whole.
std::vector<CameraParameter> Determined(const CameraEvidence& evidence) {
  std::vector<CameraParameter> determined;
  for (const ParameterEvidence& one : evidence.parameters) {
    const bool is_known =
        one.parameter.IsCoefficient() ? evidence.IsDistortionDetermined() : one.IsDetermined();
    const bool is_whole_known = one.parameter.IsCentring() ? evidence.IsCentringDetermined()
                                : one.parameter.kind == CameraParameter::Kind::kDepthPose
                                    ? evidence.IsDepthPoseDetermined()
                                    : true;
    if (one.parameter.IsNuisance() || (is_known && is_whole_known)) {
      determined.push_back(one.parameter);
    }
  }
  return determined;
}

// Whether the focal length that was found is the trusted one within the scale of depth.
bool AgreesWithTrust(const CameraModel& found, const CalibrationProblem& problem,
                     const CameraCalibrationOptions& options) {
  const bool has_metre = problem.has_depth && !found.is_pair && options.trusted_focal_length > 0.0;
  return has_metre && std::abs(std::log(found.camera.fx / options.trusted_focal_length)) <
                          2.0 * kDepthScaleSigma;
}

CameraModel WithFocalLength(CameraModel model, double fx) {
  model.camera.fy *= fx / model.camera.fx;
  model.camera.fx = fx;
  return model;
}

}  // namespace

bool CameraCalibrationResult::IsCalibrated(const std::string& name) const {
  return std::ranges::find(calibrated, name) != calibrated.end();
}

CameraCalibrationResult CalibrateCamera(const CalibrationProblem& problem, const CameraModel& given,
                                        const CameraCalibrationOptions& options) {
  CameraAdjustment fixed(problem, given, {});
  fixed.Solve({});
  if (problem.has_depth) {  // what its disparities are worth
    CalibrationProblem weighted = fixed.problem();
    weighted.disparity_sigma = fixed.DisparitySigma();
    fixed = CameraAdjustment(std::move(weighted), given, {});
    fixed.Solve({});
  }
  CameraModel start = given;
  std::vector<CameraParameter> parameters =
      ParametersOf(given, options.choice, problem.has_depth, MedianSpeed(problem, given));
  if (options.guess) {
    ExpectNear(*options.guess, parameters);
  }
  CameraAdjustment free(fixed.problem(), start, parameters);
  free.Solve({});
  CameraEvidence evidence = MeasureEvidence(free);
  CameraCalibrationResult result{.given = given,
                                 .model = given,
                                 .evidence = evidence,
                                 .calibrated = {},
                                 .median_error_before = fixed.MedianError()};
  const auto hold_others = [&](std::vector<CameraParameter> kept) {
    parameters = std::move(kept);
    free = CameraAdjustment(fixed.problem(), start, parameters);
    free.Solve({});
    evidence = MeasureEvidence(free);
  };
  if (AgreesWithTrust(free.model(), problem, options)) {
    start = WithFocalLength(given, options.trusted_focal_length);
    std::erase_if(parameters, &CameraParameter::IsFocalLength);
    hold_others(parameters);
  }
  // The pose of depth images is seldom determined, and the other numbers are known less with it.
  const auto is_of_depth_pose = [](const CameraParameter& one) {
    return one.kind == CameraParameter::Kind::kDepthPose;
  };
  if (!evidence.IsDepthPoseDetermined() && std::erase_if(parameters, is_of_depth_pose) > 0) {
    hold_others(parameters);
  }
  // What is not determined is held, so that the rest may become determined or not. Two rounds
  // settle it.
  for (int round = 0; round < 2 && !options.guess; ++round) {
    std::vector<CameraParameter> kept = Determined(evidence);
    if (kept.size() == parameters.size()) {
      break;
    }
    hold_others(std::move(kept));
  }
  result.median_error = free.MedianError();
  const double factor = evidence.jackknife_factor;
  result.evidence_ratio =
      2.0 * (fixed.cost() - free.cost()) / (evidence.variance_factor * factor * factor);
  for (ParameterEvidence& one : result.evidence.parameters) {
    if (const ParameterEvidence* const held = evidence.Find(one.parameter.name)) {
      one = *held;
      result.calibrated.push_back(one.parameter.name);
    }
  }
  std::erase(result.calibrated, kDepthScaleName);
  std::erase_if(result.evidence.parameters,
                [](const ParameterEvidence& one) { return one.parameter.IsNuisance(); });
  // 4 sigmas for as many numbers: a right camera is practically never changed.
  const auto numbers = static_cast<double>(parameters.size());
  result.is_changed =
      options.guess ||
      (numbers > 0.0 && result.evidence_ratio > numbers + 4.0 * std::sqrt(2.0 * numbers));
  if (result.is_changed) {
    result.model = free.model();
    result.model.depth_scale = given.depth_scale;
  }
  return result;
}

}  // namespace hullslam
