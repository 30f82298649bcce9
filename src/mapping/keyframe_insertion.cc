// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/keyframe_insertion.h"

#include <algorithm>

#include "map/covisibility.h"
#include "map/landmark_edits.h"
#include "map/spanning_tree.h"

namespace hullslam {
namespace {

constexpr size_t kMinDepthLandmarks = 100;

void ApplySightings(Map& map, const std::vector<Sighting>& sightings) {
  for (const Sighting& sighting : sightings) {
    const LandmarkId landmark = map.Resolve(sighting.landmark);
    if (landmark.IsValid()) {
      map.CountSightings(landmark, sighting.visible, sighting.found);
    }
  }
}

void AddKnownLandmarks(Map& map, KeyframeId id, const std::vector<LandmarkId>& landmarks,
                       const ScaleLevels& levels) {
  for (uint32_t keypoint = 0; keypoint < landmarks.size(); ++keypoint) {
    const LandmarkId landmark = map.Resolve(landmarks[keypoint]);
    if (landmark.IsValid() && map.AddObservation(landmark, id, keypoint)) {
      UpdateDescriptor(map, landmark);
      UpdateViewingGeometry(map, landmark, levels);
    }
  }
}

// Keypoints with depth, nearest first.
std::vector<uint32_t> ByDepth(const FrameFeatures& features) {
  std::vector<uint32_t> keypoints;
  for (uint32_t i = 0; i < features.size(); ++i) {
    if (features.depth[i] > 0.0f) {
      keypoints.push_back(i);
    }
  }
  std::stable_sort(keypoints.begin(), keypoints.end(),
                   [&](uint32_t a, uint32_t b) { return features.depth[a] < features.depth[b]; });
  return keypoints;
}

void AddDepthLandmarks(Map& map, KeyframeId id, const Sensor& sensor, bool all,
                       std::vector<LandmarkId>& created) {
  const std::shared_ptr<const Frame> frame = map.keyframes().At(id).frame;
  const Rigid3 world_from_cam = Inverse(map.keyframes().At(id).cam_from_world);
  size_t count = 0;
  for (const uint32_t keypoint : ByDepth(frame->features)) {
    const double depth = static_cast<double>(frame->features.depth[keypoint]);
    if (!all && depth > sensor.close_depth && count >= kMinDepthLandmarks) {
      break;
    }
    ++count;
    if (map.keyframes().At(id).landmarks[keypoint].IsValid()) {
      continue;
    }
    const Eigen::Vector2d pixel = frame->features.keypoints[keypoint].undistorted.cast<double>();
    const LandmarkId landmark =
        map.AddLandmark(world_from_cam * sensor.camera.Unproject(pixel, depth), id);
    map.AddObservation(landmark, id, keypoint);
    UpdateDescriptor(map, landmark);
    UpdateViewingGeometry(map, landmark, sensor.levels);
    created.push_back(landmark);
  }
}

}  // namespace

KeyframeId InsertKeyframe(Map& map, const KeyframeRequest& request, const Sensor& sensor,
                          std::vector<LandmarkId>& created) {
  const bool is_first = !request.reference.IsValid();
  const Rigid3 cam_from_world =
      is_first ? request.cam_from_reference
               : request.cam_from_reference * map.CamFromWorld(request.reference);
  const KeyframeId id = map.AddKeyframe(request.frame, cam_from_world);
  ApplySightings(map, request.sightings);
  AddKnownLandmarks(map, id, request.landmarks, sensor.levels);
  UpdateCovisibility(map, id);
  if (!is_first && !map.keyframes().At(id).parent.IsValid()) {
    // All it knew is gone meanwhile; it still must not become a second root.
    SetParent(map, id, map.NearestAlive(request.reference));
  }
  AddDepthLandmarks(map, id, sensor, is_first, created);
  return id;
}

}  // namespace hullslam
