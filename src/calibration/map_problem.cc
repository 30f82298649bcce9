// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/map_problem.h"

#include <algorithm>
#include <optional>

namespace hullslam {
namespace {

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

IslandId LargestIsland(const Map& map) {
  std::unordered_map<uint32_t, size_t> sizes;
  IslandId largest{0};
  size_t most = 0;
  map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    if (const size_t size = ++sizes[keyframe.island.value]; size > most) {
      most = size;
      largest = keyframe.island;
    }
  });
  return largest;
}

ChosenViews ChooseViews(const Map& map, const Trajectory& trajectory) {
  struct Candidate {
    KeyframeId id;
    CalibrationView view;
  };
  const IslandId island = LargestIsland(map);
  std::vector<Candidate> candidates;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (!(keyframe.island == island)) {
      return;
    }
    const double timestamp = keyframe.frame->timestamp;
    if (const auto velocity = VelocityAt(trajectory, timestamp)) {
      candidates.push_back({id, {timestamp, keyframe.cam_from_world, *velocity}});
    }
  });
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

}  // namespace

void RawKeypoints::Note(const FrameReport& report) {
  const Frame& frame = *report.frame;
  if (frame.shutter == nullptr) {
    return;
  }
  auto& raw = of_frame_[frame.id.value];
  for (size_t i = 0; i < frame.features.size(); ++i) {
    const Eigen::Vector2f& corrected = frame.features.keypoints[i].undistorted;
    const Eigen::Vector2d read =
        BeforeCorrection(sensor_, *frame.shutter, corrected.cast<double>(), i);
    raw.emplace(Key(corrected.x(), corrected.y()), sensor_.camera.Distort(read).cast<float>());
  }
}

Eigen::Vector2d RawKeypoints::RawOf(const Frame& frame, size_t keypoint) const {
  const Eigen::Vector2f& pixel = frame.features.keypoints[keypoint].undistorted;
  if (const auto of_frame = of_frame_.find(frame.id.value); of_frame != of_frame_.end()) {
    const auto it = of_frame->second.find(Key(pixel.x(), pixel.y()));
    if (it != of_frame->second.end()) {
      return it->second.cast<double>();
    }
  }
  return sensor_.camera.Distort(pixel.cast<double>());
}

CameraModel ModelOf(const Sensor& sensor) {
  return {.camera = sensor.camera,
          .readout_time = sensor.readout_time,
          .readout_direction = sensor.readout_direction,
          .is_pair = sensor.IsStereo()};
}

CalibrationProblem MakeProblem(const Map& map, const Sensor& sensor, const Trajectory& trajectory,
                               const RawKeypoints& raw) {
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
           .raw = raw.RawOf(frame, observation.keypoint),
           .sigma =
               sensor.depth_error.pixel_sigma * static_cast<double>(sensor.levels.scale[level]),
           .disparity = depth > 0.0 && problem.has_depth ? sensor.camera.bf / depth : 0.0});
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
