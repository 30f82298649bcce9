// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/recorded_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
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

// Objects say nothing about the camera. Without them frames keep what undoes the correction of
// their shutter.
SystemOptions OptionsOfRun(SystemOptions options) {
  options.objects.enabled = false;
  return options;
}

// SLAM on the first `frames` frames of a recording. Empty if there is no map. Throws the error of
// the first image if no image can be read.
CalibrationProblem ProblemOf(const SystemOptions& options, const CameraRecording& recording,
                             size_t frames, const RecordedCalibrationOptions& calibration,
                             const std::function<void()>& on_frame) {
  const Sensor sensor = MakeSensor(options);
  System system(options, PipelineKind::kSequential);
  std::optional<InputError> failure;
  for (size_t i = 0; i < frames && !IsRequested(calibration.cancellation); ++i) {
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
  system.Finish(calibration.cancellation);
  const auto map = system.map();
  const CameraModel model = ModelOf(sensor, options.depth.disparity_offset);
  return map == nullptr ? CalibrationProblem()
                        : MakeProblem(*map, sensor, model, system.trajectory());
}

bool IsEnough(const CalibrationProblem& problem) {
  return problem.views.size() >= kFewestViews && problem.CountObservations() >= kFewestObservations;
}

// The largest change of a pixel by a step of the camera, about, px.
double ChangeOf(const CameraModel& a, const CameraModel& b,
                std::span<const CameraParameter> parameters) {
  double change = 0.0;
  for (const CameraParameter& parameter : parameters) {
    change =
        std::max(change, std::abs(parameter.ValueIn(a) - parameter.ValueIn(b)) / parameter.step);
  }
  return change;
}

std::vector<CameraParameter> ParametersIn(const CameraEvidence& evidence) {
  std::vector<CameraParameter> parameters;
  for (const ParameterEvidence& one : evidence.parameters) {
    parameters.push_back(one.parameter);
  }
  return parameters;
}

}  // namespace

void ApplyModel(const CameraModel& model, SystemOptions& options) {
  options.camera = model.camera;
  options.readout_time = model.readout_time;
  options.readout_direction = model.readout_direction;
  options.depth.disparity_offset = model.disparity_offset;
}

RecordedCalibration CalibrateFromRecordings(SystemOptions options,
                                            std::span<const CameraRecording> recordings,
                                            const RecordedCalibrationOptions& calibration) {
  constexpr double kSettled = 0.2;  // px
  options = OptionsOfRun(std::move(options));
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
      problem.Append(ProblemOf(options, recording, recording.frames, calibration, [&] {
        if (calibration.on_frame) {
          calibration.on_frame(pass, ++done, frames);
        }
      }));
    }
    if (!IsEnough(problem)) {
      throw InputError(fmt::format(
          "a map of {} views and {} observations is too small to calibrate a camera, expected at "
          "least {} and {}: film for longer, and move the camera",
          problem.views.size(), problem.CountObservations(), kFewestViews, kFewestObservations));
    }
    calibrated.result = CalibrateCamera(problem, model, calibration.camera);
    calibrated.problem = std::move(problem);
    calibrated.passes = pass;
    const double change =
        ChangeOf(model, calibrated.result.model, ParametersIn(calibrated.result.evidence));
    model = calibrated.result.model;
    if (IsRequested(calibration.cancellation) || change < kSettled) {
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

PinholeCamera GuessCamera(SystemOptions options, const CameraRecording& recording,
                          const RecordedCalibrationOptions& calibration) {
  constexpr size_t kFrames = 150;
  constexpr double kDegree = std::numbers::pi / 180.0;
  options = OptionsOfRun(std::move(options));
  options.readout_time = 0.0;
  options.depth.disparity_offset = 0.0;
  const PinholeCamera sized{
      .width = options.camera.width, .height = options.camera.height, .bf = options.camera.bf};
  const size_t frames = std::min(kFrames, recording.frames);
  size_t done = 0;
  double most = 0.0;
  std::optional<PinholeCamera> best;
  constexpr std::array kFields = {45.0, 55.0, 65.0, 75.0, 87.0, 100.0};  // degrees
  for (const double field : kFields) {
    PinholeCamera& camera = options.camera;
    camera = sized;
    camera.cx = 0.5 * (camera.width - 1);
    camera.cy = 0.5 * (camera.height - 1);
    camera.fx = camera.fy = 0.5 * camera.width / std::tan(0.5 * field * kDegree);
    const CalibrationProblem problem = ProblemOf(options, recording, frames, calibration, [&] {
      if (calibration.on_frame) {
        calibration.on_frame(0, ++done, kFields.size() * frames);
      }
    });
    if (!IsEnough(problem) || IsRequested(calibration.cancellation)) {
      continue;
    }
    const CameraModel model = ModelOf(MakeSensor(options), 0.0);
    CameraAdjustment adjustment(
        problem, model,
        ParametersOf(model, {.principal_point = false, .readout = false, .disparity = false},
                     problem.has_depth, 0.0));
    adjustment.Solve({});
    // A wrong camera loses landmarks, and the errors of those that are left are larger.
    const double score = static_cast<double>(problem.CountObservations()) /
                         std::max(0.1, adjustment.AtMinimum().variance_factor);
    if (score > most) {
      most = score;
      best = adjustment.model().camera;
    }
  }
  if (!best) {
    throw InputError(
        "no map can be made of the first images with any field of view from 45 to 100 degrees, "
        "expected a camera that moves sideways past things at different distances");
  }
  return *best;
}

}  // namespace hullslam
