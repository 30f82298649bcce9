// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/contradicted_landmarks.h"

#include <optional>
#include <vector>

#include "frame/depth_sight.h"
#include "map/covisibility.h"
#include "map/keyframe_order.h"
#include "map/landmark_projection.h"

namespace hullslam {
namespace {

// A static landmark is contradicted by mistake in at most 2.5 % of the keyframes (one side of the
// bound below), so by three of them once in 60 000 times: less than one landmark in a map.
constexpr int kContradictions = 3;

Sight LookAtLandmark(const Sensor& sensor, const Keyframe& keyframe, const Landmark& landmark) {
  const DepthGrid& grid = keyframe.frame->depth;
  const std::optional<LandmarkProjection> view =
      ProjectLandmark(sensor, keyframe.cam_from_world, landmark);
  return view && !grid.empty() ? LookAt(sensor, grid, view->pixel, view->point_in_cam)
                               : Sight::kUnclear;
}

}  // namespace

size_t EraseContradictedLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                                  Contradictions<LandmarkId>& contradictions) {
  const Keyframe& keyframe = map.keyframes().At(current);
  if (keyframe.frame->depth.empty()) {
    return 0;
  }
  std::vector<KeyframeId> neighbours;
  for (const Covisible& neighbour : keyframe.covisible) {
    neighbours.push_back(neighbour.keyframe);
  }
  std::vector<LandmarkId> contradicted;
  for (const LandmarkId id : ObservedLandmarks(map, neighbours)) {
    const Landmark& landmark = map.landmarks().At(id);
    const FrameId last_seen = FrameIdOf(map, LastObserver(map, landmark.observations));
    if (last_seen >= keyframe.frame->id) {
      continue;
    }
    const Sight sight = LookAtLandmark(sensor, keyframe, landmark);
    if (sight == Sight::kSurface) {
      contradictions.Forget(id);
    } else if (sight == Sight::kPast && contradictions.Add(id, last_seen) == kContradictions) {
      contradicted.push_back(id);
    }
  }
  for (const LandmarkId id : contradicted) {
    contradictions.Forget(id);
    map.EraseLandmark(id);
  }
  return contradicted.size();
}

}  // namespace hullslam
