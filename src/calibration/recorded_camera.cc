// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/recorded_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "frame/rolling_shutter.h"
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

constexpr size_t kMostViews = 150;
constexpr size_t kMostPoints = 6000;

// The velocity of the camera at the time of a pose of the trajectory, from its neighbours. Null if
// they are too far away in time.
std::optional<PointVelocity> VelocityAt(const Trajectory& trajectory, double timestamp) {
  constexpr double kMostGap = 0.25;  // s, between the two neighbours
  const auto it =
      std::ranges::lower_bound(trajectory, timestamp - 1e-6, {}, &StampedPose::timestamp);
  if (it == trajectory.end() || it == trajectory.begin() || it + 1 == trajectory.end()) {
    return std::nullopt;
  }
  const StampedPose& before = *(it - 1);
  const StampedPose& after = *(it + 1);
  const double duration = after.timestamp - before.timestamp;
  if (!(duration > 0.0) || duration > kMostGap) {
    return std::nullopt;
  }
  return MeanVelocity(Inverse(after.world_from_cam) * before.world_from_cam, duration);
}

// The views of a problem and their numbers.
struct ChosenViews {
  std::vector<CalibrationView> views;
  std::unordered_map<uint32_t, uint32_t> number_of_keyframe;
};

// The keyframes with a velocity; all of them, without velocities, if those are few.
ChosenViews ChooseViews(const Map& map, const Trajectory& trajectory) {
  struct Candidate {
    KeyframeId id;
    CalibrationView view;
  };
  std::vector<Candidate> all;
  std::vector<Candidate> moving;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    const double timestamp = keyframe.frame->timestamp;
    const Candidate still{
        id, {.timestamp = timestamp, .cam_from_world = keyframe.cam_from_world, .velocity = {}}};
    all.push_back(still);
    if (const auto velocity = VelocityAt(trajectory, timestamp)) {
      moving.push_back(still);
      moving.back().view.velocity = *velocity;
    }
  });
  std::vector<Candidate>& candidates = 2 * moving.size() >= all.size() ? moving : all;
  std::ranges::sort(candidates, {}, [](const Candidate& one) { return one.view.timestamp; });
  ChosenViews chosen;
  const size_t count = std::min(kMostViews, candidates.size());
  for (size_t i = 0; i < count; ++i) {
    const Candidate& one = candidates[i * candidates.size() / count];
    chosen.number_of_keyframe[one.id.value] = static_cast<uint32_t>(chosen.views.size());
    chosen.views.push_back(one.view);
  }
  return chosen;
}

// The raw pixel of a keypoint, before its shutter was corrected.
Eigen::Vector2d RawPixelOf(const Sensor& sensor, const Frame& frame, size_t keypoint) {
  Eigen::Vector2d pixel = frame.features.keypoints[keypoint].undistorted.cast<double>();
  if (frame.shutter != nullptr) {
    pixel = BeforeCorrection(sensor, *frame.shutter, pixel, keypoint);
  }
  return sensor.camera.Distort(pixel);
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
    if (IsRequested(calibration.cancellation)) {
      return calibrated;
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
    if (is_settled) {
      break;
    }
  }
  if (calibrated.result.evidence.IsContradictory()) {
    throw InputError(fmt::format(
        "no camera fits all parts of the recording: their numbers differ by {:.0f} times what "
        "chance explains, expected one camera without zoom, autofocus and stabilisation",
        calibrated.result.evidence.jackknife_factor));
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

CameraModel ModelOf(const Sensor& sensor, double disparity_offset) {
  return {.camera = sensor.camera,
          .readout_time = sensor.readout_time,
          .readout_direction = sensor.readout_direction,
          .disparity_offset = disparity_offset,
          .is_pair = sensor.IsStereo()};
}

CalibrationProblem MakeProblem(const Map& map, const Sensor& sensor, const CameraModel& model,
                               const Trajectory& trajectory) {
  ChosenViews chosen = ChooseViews(map, trajectory);
  CalibrationProblem problem;
  problem.has_depth = !sensor.IsMonocular();
  problem.disparity_sigma = sensor.depth_error.disparity_sigma;
  problem.views = std::move(chosen.views);
  const size_t fewest = sensor.IsMonocular() ? 4 : 3;
  struct Track {
    Eigen::Vector3d position;
    std::vector<CalibrationObservation> seen;
  };
  std::vector<Track> tracks;
  map.landmarks().ForEach([&](LandmarkId, const Landmark& landmark) {
    Track track{.position = landmark.position, .seen = {}};
    for (const Observation& observation : landmark.observations) {
      const auto number = chosen.number_of_keyframe.find(observation.keyframe.value);
      if (number == chosen.number_of_keyframe.end()) {
        continue;
      }
      const Frame& frame = *map.keyframes().At(observation.keyframe).frame;
      const FrameFeatures& features = frame.features;
      const double depth = static_cast<double>(features.depth[observation.keypoint]);
      const auto level = static_cast<size_t>(features.keypoints[observation.keypoint].level);
      track.seen.push_back(
          {.view = number->second,
           .raw = RawPixelOf(sensor, frame, observation.keypoint),
           .sigma =
               sensor.depth_error.pixel_sigma * static_cast<double>(sensor.levels.scale[level]),
           .disparity = depth > 0.0 ? sensor.camera.bf / depth + model.disparity_offset : 0.0});
    }
    if (track.seen.size() >= fewest) {
      tracks.push_back(std::move(track));
    }
  });
  std::ranges::stable_sort(tracks, std::greater(),
                           [](const Track& one) { return one.seen.size(); });
  tracks.resize(std::min(tracks.size(), kMostPoints));
  for (Track& track : tracks) {
    problem.points.push_back(track.position);
    problem.observations.push_back(std::move(track.seen));
  }
  return problem;
}

}  // namespace hullslam
