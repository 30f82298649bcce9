// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/recorded_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibration/map_problem.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"
#include "system/make_sensor.h"

namespace hullslam {
namespace {

constexpr size_t kFewestViews = 8;
constexpr size_t kFewestObservations = 500;

// Whether all numbers of a camera are those of another one within their standard deviations.
bool IsWithinErrors(const CameraModel& a, const CameraModel& b, const CameraEvidence& evidence) {
  return std::ranges::all_of(evidence.parameters, [&](const ParameterEvidence& one) {
    return std::abs(one.parameter.ValueIn(a) - one.parameter.ValueIn(b)) <= one.sigma;
  });
}

}  // namespace

// Objects say nothing about the camera. Without them frames keep what undoes the correction of
// their shutter.
CalibrationProblem RecordedProblem(SystemOptions options, const CameraRecording& recording,
                                   size_t frames, const Cancellation* cancellation,
                                   const std::function<void()>& on_frame) {
  options.objects.enabled = false;
  const Sensor sensor = MakeSensor(options);
  System system(options, PipelineKind::kSequential);
  std::optional<InputError> failure;
  for (size_t i = 0; i < frames && !IsRequested(cancellation); ++i) {
    std::optional<ImageInput> image;
    try {
      image = recording.load(i, options.camera);
    } catch (const InputError& error) {
      failure = failure ? failure : error;  // the frame is left out, as in a run
    }
    if (image) {
      image->masks.clear();
      image->right_masks.clear();
      system.Track(*image);
    }
    on_frame();
  }
  if (failure && system.frames().empty()) {
    throw *failure;
  }
  system.Finish(cancellation);
  const auto map = system.map();
  const CameraModel model = ModelOf(sensor, options.depth.disparity_offset);
  return map == nullptr ? CalibrationProblem()
                        : MakeProblem(*map, sensor, model, system.trajectory());
}

bool IsEnoughToCalibrate(const CalibrationProblem& problem) {
  return problem.views.size() >= kFewestViews && problem.CountObservations() >= kFewestObservations;
}

void ApplyModel(const CameraModel& model, SystemOptions& options) {
  options.camera = model.camera;
  options.readout_time = model.readout_time;
  options.readout_direction = model.readout_direction;
  options.depth.disparity_offset = model.disparity_offset;
}

RecordedCalibration CalibrateFromRecordings(SystemOptions options,
                                            std::span<const CameraRecording> recordings,
                                            const RecordedCalibrationOptions& calibration) {
  CameraModel model = ModelOf(MakeSensor(options), options.depth.disparity_offset);
  const CameraModel given = model;
  size_t frames = 0;
  for (const CameraRecording& recording : recordings) {
    frames += recording.frames;
  }
  RecordedCalibration calibrated;
  for (int pass = 1; pass <= calibration.max_passes; ++pass) {
    ApplyModel(model, options);
    CalibrationProblem problem;
    size_t done = 0;
    for (const CameraRecording& recording : recordings) {
      problem.Append(
          RecordedProblem(options, recording, recording.frames, calibration.cancellation, [&] {
            if (calibration.on_frame) {
              calibration.on_frame(pass, ++done, frames);
            }
          }));
    }
    if (!IsEnoughToCalibrate(problem)) {
      throw InputError(fmt::format(
          "a map of {} views and {} observations is too small to calibrate a camera, expected at "
          "least {} and {}: film for longer, and move the camera",
          problem.views.size(), problem.CountObservations(), kFewestViews, kFewestObservations));
    }
    calibrated.result = CalibrateCamera(problem, model, calibration.camera);
    calibrated.problem = std::move(problem);
    calibrated.passes = pass;
    const bool is_settled =
        IsWithinErrors(model, calibrated.result.model, calibrated.result.evidence);
    model = calibrated.result.model;
    if (is_settled || IsRequested(calibration.cancellation)) {
      break;
    }
  }
  // Also what an earlier pass has changed is calibrated.
  CameraCalibrationResult& result = calibrated.result;
  result.given = given;
  if (calibrated.passes > 1) {
    CameraAdjustment fixed(calibrated.problem, given, {});
    fixed.Solve({});
    result.median_error_before = fixed.MedianError();
  }
  result.is_changed = false;
  for (const ParameterEvidence& one : result.evidence.parameters) {
    if (one.parameter.ValueIn(given) != one.parameter.ValueIn(model)) {
      result.is_changed = true;
      if (!result.IsCalibrated(one.parameter.name)) {
        result.calibrated.push_back(one.parameter.name);
      }
    }
  }
  return calibrated;
}

}  // namespace hullslam
