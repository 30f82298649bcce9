// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/recorded_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "frame/measure_point.h"
#include "frame/rolling_shutter.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"
#include "system/make_sensor.h"

namespace hullslam {
namespace {

constexpr size_t kFewestViews = 8;
constexpr size_t kFewestObservations = 500;
constexpr size_t kMostViews = 150;
constexpr size_t kMostPoints = 6000;

// Whether no number of a camera has changed by more than what moves pixels at the border by a
// quarter, or by more than chance explains.
bool IsSettled(const CameraModel& before, const CameraModel& after,
               const CameraEvidence& evidence) {
  constexpr double kSteps = 0.25;
  return std::ranges::all_of(evidence.parameters, [&](const ParameterEvidence& one) {
    return std::abs(one.parameter.ValueIn(after) - one.parameter.ValueIn(before)) <=
           std::max(kSteps * one.parameter.step, one.bundle_sigma);
  });
}

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

// The pose of the trajectory at exactly this time; null if there is none.
const StampedPose* PoseAt(const Trajectory& trajectory, double timestamp) {
  const auto it =
      std::ranges::lower_bound(trajectory, timestamp - 1e-6, {}, &StampedPose::timestamp);
  return it != trajectory.end() && it->timestamp < timestamp + 1e-6 ? &*it : nullptr;
}

std::vector<SeenView> Keyframes(const Map& map, const Sensor& sensor, const CameraModel& model) {
  std::vector<SeenView> views;
  map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    views.push_back(SeenViewOf(*keyframe.frame, keyframe.landmarks, sensor, model));
    views.back().view.cam_from_world = keyframe.cam_from_world;
  });
  return views;
}

// At most `most` views with a velocity, evenly chosen; all of them without velocities if those are
// few. By time.
std::vector<SeenView> Chosen(std::vector<SeenView> views, const Trajectory& trajectory,
                             size_t most) {
  std::ranges::stable_sort(views, {}, [](const SeenView& one) { return one.view.timestamp; });
  std::vector<std::optional<PointVelocity>> velocities;
  for (const SeenView& one : views) {
    velocities.push_back(VelocityAt(trajectory, one.view.timestamp));
  }
  const auto moving = static_cast<size_t>(
      std::ranges::count_if(velocities, [](const auto& velocity) { return velocity.has_value(); }));
  if (2 * moving >= views.size()) {
    std::vector<SeenView> with_velocity;
    for (size_t i = 0; i < views.size(); ++i) {
      if (velocities[i]) {
        with_velocity.push_back(std::move(views[i]));
        with_velocity.back().view.velocity = *velocities[i];
      }
    }
    views = std::move(with_velocity);
  }
  std::vector<SeenView> chosen;
  const size_t count = std::min(most, views.size());
  for (size_t i = 0; i < count; ++i) {
    chosen.push_back(std::move(views[i * views.size() / count]));
  }
  return chosen;
}

// A pose needs three points; with as few as that, one wrong one would move it far.
void EraseWeakViews(std::vector<SeenView>& views) {
  constexpr size_t kFewestLandmarks = 15;
  std::erase_if(views, [](const SeenView& one) { return one.landmarks.size() < kFewestLandmarks; });
}

// Keeps the landmarks that `fewest` views see, and the views that see enough of these. Returns the
// number of views that see each.
std::map<LandmarkId, size_t> KeepTracks(size_t fewest, std::vector<SeenView>& views) {
  while (true) {
    std::map<LandmarkId, size_t> counts;
    for (const SeenView& one : views) {
      for (const auto& [id, seen] : one.landmarks) {
        ++counts[id];
      }
    }
    std::erase_if(counts, [&](const auto& one) { return one.second < fewest; });
    for (SeenView& one : views) {
      std::erase_if(one.landmarks, [&](const auto& seen) { return !counts.contains(seen.first); });
    }
    const size_t before = views.size();
    EraseWeakViews(views);
    if (views.size() == before) {
      return counts;
    }
  }
}

// The undistorted pixel of a keypoint, before its shutter was corrected.
Eigen::Vector2d PixelOf(const Sensor& sensor, const Frame& frame, size_t keypoint) {
  Eigen::Vector2d pixel = frame.features.keypoints[keypoint].undistorted.cast<double>();
  if (frame.shutter != nullptr) {
    pixel = BeforeCorrection(sensor, *frame.shutter, pixel, keypoint);
  }
  return pixel;
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
  const CameraModel model = ModelOf(sensor, options.depth);
  std::vector<SeenView> seen;
  system.SetFrameCallback([&](const FrameReport& report) {
    seen.push_back(SeenViewOf(*report.frame, report.landmarks, sensor, model));
  });
  std::optional<InputError> failure;
  const auto build = [&](size_t i) -> std::optional<BuiltFrame> {
    if (i >= frames) {
      return std::nullopt;
    }
    std::optional<ImageInput> image;
    try {
      image = recording.load(i, options.camera);
    } catch (const InputError& error) {
      failure = failure ? failure : error;  // the frame is left out, as in a run
      return std::nullopt;
    }
    image->masks.clear();
    image->right_masks.clear();
    return system.Build(*image);
  };
  // Another thread builds the next frame while this one tracks.
  auto next = std::async(std::launch::async, build, 0);
  for (size_t i = 0; i < frames && !IsRequested(cancellation); ++i) {
    std::optional<BuiltFrame> built = next.get();
    next = std::async(std::launch::async, build, i + 1);
    if (built) {
      system.Track(std::move(*built));
    }
    on_frame();
  }
  next.wait();
  if (failure && system.frames().empty()) {
    throw *failure;
  }
  system.Finish(cancellation);
  const auto map = system.map();
  return map == nullptr ? CalibrationProblem()
                        : MakeProblem(*map, sensor, model, system.trajectory(), std::move(seen));
}

bool IsEnoughToCalibrate(const CalibrationProblem& problem) {
  return problem.views.size() >= kFewestViews && problem.CountObservations() >= kFewestObservations;
}

void ApplyModel(const CameraModel& model, SystemOptions& options) {
  options.camera = model.camera;
  options.readout_time = model.readout_time;
  options.readout_direction = model.readout_direction;
  if (!model.is_pair) {  // that of a pair is not known to SLAM, but is a yaw (CalibratePair)
    options.depth.disparity_offset = model.disparity_offset;
  }
  options.depth.time_offset = model.depth_time;
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(options.depth.pose.data()) = model.depth_pose;
}

RecordedCalibration CalibrateFromRecordings(SystemOptions options,
                                            std::span<const CameraRecording> recordings,
                                            const RecordedCalibrationOptions& calibration) {
  CameraModel model = ModelOf(MakeSensor(options), options.depth);
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
    // What the user gave counts until the recording says otherwise; a guess does not.
    calibrated.result =
        CalibrateCamera(problem, calibration.camera.guess ? model : given, calibration.camera);
    calibrated.problem = std::move(problem);
    calibrated.passes = pass;
    const bool is_settled = IsSettled(model, calibrated.result.model, calibrated.result.evidence);
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
  calibrated.result.given = given;
  if (calibration.camera.guess) {
    CameraAdjustment fixed(calibrated.problem, given, {});
    fixed.Solve({});
    calibrated.result.median_error_before = fixed.MedianError();
  }
  return calibrated;
}

CameraModel ModelOf(const Sensor& sensor, const DepthOptions& depth) {
  return {.camera = sensor.camera,
          .readout_time = sensor.readout_time,
          .readout_direction = sensor.readout_direction,
          .disparity_offset = depth.disparity_offset,
          .is_pair = sensor.IsStereo(),
          .depth_time = depth.time_offset,
          .depth_pose = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(depth.pose.data())};
}

SeenView SeenViewOf(const Frame& frame, std::span<const LandmarkId> landmarks, const Sensor& sensor,
                    const CameraModel& model) {
  SeenView seen{.view = {.timestamp = frame.timestamp, .cam_from_world = {}, .velocity = {}},
                .landmarks = {}};
  const FrameFeatures& features = frame.features;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (!landmarks[i].IsValid()) {
      continue;
    }
    const double depth = frame.shutter != nullptr ? frame.shutter->depths[i] : features.depth[i];
    const Eigen::Vector2d pixel = PixelOf(sensor, frame, i);
    const Eigen::Vector2d raw = sensor.camera.Distort(pixel);
    const std::optional<Eigen::Vector2d> slope =
        DisparitySlope(sensor.camera, frame.depth, pixel, raw);
    const auto level = static_cast<size_t>(features.keypoints[i].level);
    seen.landmarks.emplace_back(
        landmarks[i],
        CalibrationObservation{.view = 0,
                               .raw = raw,
                               .sigma = sensor.depth_error.pixel_sigma *
                                        static_cast<double>(sensor.levels.scale[level]),
                               .disparity = depth > 0.0 && (slope || sensor.IsStereo())
                                                ? sensor.camera.bf / depth + model.disparity_offset
                                                : 0.0,
                               .slope = slope.value_or(Eigen::Vector2d::Zero()),
                               .depth_delay = frame.depth_delay});
  }
  return seen;
}

CalibrationProblem MakeProblem(const Map& map, const Sensor& sensor, const CameraModel& model,
                               const Trajectory& trajectory, std::vector<SeenView> frames) {
  std::vector<SeenView> views = Keyframes(map, sensor, model);
  std::set<double> known;
  for (const SeenView& one : views) {
    known.insert(one.view.timestamp);
  }
  for (SeenView& one : frames) {
    const StampedPose* const pose = PoseAt(trajectory, one.view.timestamp);
    if (pose != nullptr && !known.contains(one.view.timestamp)) {
      one.view.cam_from_world = Inverse(pose->world_from_cam);
      views.push_back(std::move(one));
    }
  }
  for (SeenView& one : views) {
    std::erase_if(one.landmarks,
                  [&](const auto& seen) { return !map.landmarks().Contains(seen.first); });
  }
  EraseWeakViews(views);
  views = Chosen(std::move(views), trajectory, kMostViews);
  const std::map<LandmarkId, size_t> counts = KeepTracks(sensor.IsMonocular() ? 4 : 3, views);
  std::vector<LandmarkId> ids;
  for (const auto& [id, count] : counts) {
    ids.push_back(id);
  }
  std::ranges::stable_sort(ids, std::greater(), [&](LandmarkId id) { return counts.at(id); });
  ids.resize(std::min(ids.size(), kMostPoints));
  CalibrationProblem problem;
  problem.has_depth = !sensor.IsMonocular();
  problem.disparity_sigma = sensor.depth_error.disparity_sigma;
  problem.known_depth_pose = model.depth_pose;
  problem.observations.resize(ids.size());
  std::map<LandmarkId, size_t> point_of;
  for (const LandmarkId id : ids) {
    point_of[id] = problem.points.size();
    problem.points.push_back(map.landmarks().At(id).position);
  }
  for (SeenView& one : views) {
    for (auto& [id, seen] : one.landmarks) {
      if (const auto point = point_of.find(id); point != point_of.end()) {
        seen.view = static_cast<uint32_t>(problem.views.size());
        problem.observations[point->second].push_back(seen);
      }
    }
    problem.views.push_back(one.view);
  }
  return problem;
}

}  // namespace hullslam
