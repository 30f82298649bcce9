// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/landmark_fusion.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "frame/measure_point.h"
#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "map/landmark_projection.h"
#include "matching/by_projection.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr size_t kFusionNeighbours = 10;
constexpr size_t kSecondNeighbours = 5;
constexpr float kRadius = 3.0f;   // px at level 0
constexpr int kMaxDistance = 50;  // Hamming

std::vector<KeyframeId> Neighbourhood(const Map& map, KeyframeId id) {
  std::vector<KeyframeId> targets = BestCovisible(map.keyframes().At(id), kFusionNeighbours);
  const std::vector<KeyframeId> first = targets;
  for (const KeyframeId neighbour : first) {
    const auto second = BestCovisible(map.keyframes().At(neighbour), kSecondNeighbours);
    targets.insert(targets.end(), second.begin(), second.end());
  }
  SortUnique(targets);
  std::erase(targets, id);
  return targets;
}

void Join(Map& map, LandmarkId landmark, LandmarkId other, const ScaleLevels& levels) {
  if (landmark == other) {
    return;
  }
  const bool keep = map.landmarks().At(landmark).observation_weight >=
                    map.landmarks().At(other).observation_weight;
  const LandmarkId kept = keep ? landmark : other;
  map.ReplaceLandmark(keep ? other : landmark, kept);
  UpdateDescriptor(map, kept);
  UpdateViewingGeometry(map, kept, levels);
}

// Searches the landmarks in one keyframe. Merges them with the landmarks found there, or adds
// observations.
void FuseInto(Map& map, KeyframeId target, const std::vector<LandmarkId>& landmarks,
              const Sensor& sensor) {
  const std::shared_ptr<const Frame> frame = map.keyframes().At(target).frame;
  const std::vector<LandmarkId> known = ObservedLandmarks(map, std::span(&target, 1));
  std::vector<Projection> projections;
  std::vector<LandmarkId> ids;
  std::vector<Eigen::Vector3d> points_in_cam;
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = map.landmarks().Find(id);
    if (landmark == nullptr || std::binary_search(known.begin(), known.end(), id)) {
      continue;
    }
    const auto view = ProjectLandmark(sensor, map.keyframes().At(target).cam_from_world, *landmark);
    if (!view) {
      continue;
    }
    Projection& projection = projections.emplace_back();
    projection.pixel = view->raw_pixel.cast<float>();
    projection.radius = kRadius * sensor.levels.scale[static_cast<size_t>(view->level)];
    projection.ExpectDepth(view->point_in_cam.z(), sensor.camera.bf);
    projection.min_level = view->level - 1;
    projection.max_level = view->level;
    projection.descriptor = landmark->descriptor;
    ids.push_back(id);
    points_in_cam.push_back(view->point_in_cam);
  }
  // Only keypoints at which the landmark may be are compared by their descriptors.
  const auto reprojects = [&](uint32_t query, uint32_t keypoint) {
    return IsInlier(sensor.camera,
                    MeasurePoint(sensor, frame->features, keypoint, sensor.depth_error),
                    points_in_cam[query]);
  };
  const std::vector<Match> matches = MatchByProjection(
      frame->features, projections, {}, {.max_distance = kMaxDistance, .may_match = reprojects});
  for (const Match& match : matches) {
    const LandmarkId landmark = map.Resolve(ids[match.query]);
    if (!landmark.IsValid()) {
      continue;
    }
    const LandmarkId other = map.keyframes().At(target).landmarks[match.keypoint];
    if (other.IsValid()) {
      Join(map, landmark, other, sensor.levels);
    } else if (map.AddObservation(landmark, target, match.keypoint)) {
      UpdateDescriptor(map, landmark);
      UpdateViewingGeometry(map, landmark, sensor.levels);
    }
  }
}

}  // namespace

void FuseLandmarks(Map& map, KeyframeId id, const Sensor& sensor) {
  const std::vector<KeyframeId> targets = Neighbourhood(map, id);
  for (const KeyframeId target : targets) {
    FuseInto(map, target, ObservedLandmarks(map, std::span(&id, 1)), sensor);
  }
  FuseInto(map, id, ObservedLandmarks(map, targets), sensor);
  UpdateCovisibility(map, id);
}

}  // namespace hullslam
