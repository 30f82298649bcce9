// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/keyframe_insertion.h"

#include <algorithm>
#include <array>

#include "hullslam/util/check.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "mapping/sensor_rules.h"

namespace hullslam {
namespace {

void ApplySightings(Map& map, const std::vector<Sighting>& sightings) {
  for (const Sighting& sighting : sightings) {
    const LandmarkId landmark = map.Resolve(sighting.landmark);
    if (landmark.IsValid()) {
      map.CountSightings(landmark, sighting.visible, sighting.found);
    }
  }
}

// Adds an observation and updates the values that follow from the observations of the landmark.
void Observe(Map& map, LandmarkId landmark, KeyframeId keyframe, uint32_t keypoint,
             const ScaleLevels& levels) {
  if (map.AddObservation(landmark, keyframe, keypoint)) {
    UpdateDescriptor(map, landmark);
    UpdateViewingGeometry(map, landmark, levels);
  }
}

void AddKnownLandmarks(Map& map, KeyframeId id, const std::vector<LandmarkId>& landmarks,
                       const ScaleLevels& levels) {
  for (uint32_t keypoint = 0; keypoint < landmarks.size(); ++keypoint) {
    const LandmarkId landmark = map.Resolve(landmarks[keypoint]);
    if (landmark.IsValid()) {
      Observe(map, landmark, id, keypoint, levels);
    }
  }
}

constexpr int kColumns = 4;
constexpr int kRows = 3;

// The cell of LandmarkRules in which a pixel is.
size_t CellOf(const PinholeCamera::Bounds& bounds, const Eigen::Vector2d& pixel) {
  const double x = (pixel.x() - bounds.min_x) / (bounds.max_x - bounds.min_x);
  const double y = (pixel.y() - bounds.min_y) / (bounds.max_y - bounds.min_y);
  const int column = std::clamp(static_cast<int>(x * kColumns), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>(y * kRows), 0, kRows - 1);
  return static_cast<size_t>(row * kColumns + column);
}

// Makes landmarks of keypoints with depth that show none yet.
void AddDepthLandmarks(Map& map, KeyframeId id, const Sensor& sensor, const LandmarkRules& rules,
                       std::vector<LandmarkId>& created) {
  const std::shared_ptr<const Frame> frame = map.keyframes().At(id).frame;
  const Rigid3 world_from_cam = Inverse(map.keyframes().At(id).cam_from_world);
  size_t count = 0;
  std::array<size_t, size_t{kColumns} * kRows> in_cells{};
  for (const uint32_t keypoint : KeypointsByDepth(frame->features)) {
    const double depth = static_cast<double>(frame->features.depth[keypoint]);
    const Eigen::Vector2d pixel = frame->features.keypoints[keypoint].undistorted.cast<double>();
    size_t& in_cell = in_cells[CellOf(sensor.camera.RawBounds(), sensor.camera.Distort(pixel))];
    if (depth > sensor.close_depth && count >= rules.enough_in_image &&
        in_cell >= rules.enough_in_cell) {
      continue;
    }
    ++count;
    ++in_cell;
    if (map.keyframes().At(id).landmarks[keypoint].IsValid()) {
      continue;
    }
    const LandmarkId landmark =
        map.AddLandmark(world_from_cam * sensor.camera.Unproject(pixel, depth), id);
    Observe(map, landmark, id, keypoint, sensor.levels);
    created.push_back(landmark);
  }
}

}  // namespace

std::vector<KeyframeId> InsertInitialMap(Map& map, const InitialMap& initial, const Sensor& sensor,
                                         std::vector<LandmarkId>& created) {
  const IslandId island = map.BeginIsland();
  std::vector<KeyframeId> ids;
  for (const InitialMap::View& view : initial.views) {
    ids.push_back(map.AddKeyframe(view.frame, view.cam_from_world, island));
  }
  for (const InitialMap::Point& point : initial.points) {
    Check(!point.observations.empty(), "an initial point needs an observation");
    const LandmarkId landmark =
        map.AddLandmark(point.position, ids.at(point.observations.front().view));
    for (const InitialMap::Observation& seen : point.observations) {
      Observe(map, landmark, ids.at(seen.view), seen.keypoint, sensor.levels);
    }
    created.push_back(landmark);
  }
  for (size_t i = 0; i < ids.size(); ++i) {
    UpdateCovisibility(map, ids[i]);
    if (i > 0 && !map.keyframes().At(ids[i]).parent.IsValid()) {
      SetParent(map, ids[i], ids.front());  // the tree has one root
    }
  }
  return ids;
}

KeyframeId InsertKeyframe(Map& map, const KeyframeRequest& request, const Sensor& sensor,
                          std::vector<LandmarkId>& created, MappingRule rule) {
  const KeyframeId id = map.AddKeyframe(request.frame, map.CamFromWorld(request.pose),
                                        IslandOf(map, request.pose.reference));
  ApplySightings(map, request.sightings);
  AddKnownLandmarks(map, id, request.landmarks, sensor.levels);
  UpdateCovisibility(map, id);
  if (!map.keyframes().At(id).parent.IsValid()) {
    // None of the landmarks of the request exists any more. The keyframe must not become a second
    // root.
    SetParent(map, id, map.NearestAlive(request.pose.reference));
  }
  AddDepthLandmarks(map, id, sensor, LandmarkRules::ForSensor(sensor, rule), created);
  return id;
}

}  // namespace hullslam
