// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_result.h"

#include <algorithm>

#include "map/landmark_edits.h"

namespace hullslam {

void ApplyBundle(Map& map, const BundleResult& result, const ScaleLevels& levels) {
  for (const auto& [landmark, keyframe] : result.outliers) {
    const Landmark* seen = map.landmarks().Find(landmark);
    if (seen == nullptr) {
      continue;
    }
    const bool observed =
        std::any_of(seen->observations.begin(), seen->observations.end(),
                    [id = keyframe](const Observation& o) { return o.keyframe == id; });
    if (observed) {
      map.RemoveObservation(landmark, keyframe);
    }
  }
  for (const auto& [keyframe, pose] : result.poses) {
    if (map.keyframes().Contains(keyframe)) {
      map.SetPose(keyframe, pose);
    }
  }
  for (const auto& [landmark, position] : result.positions) {
    if (map.landmarks().Contains(landmark)) {
      map.SetPosition(landmark, position);
      UpdateViewingGeometry(map, landmark, levels);
    }
  }
  for (const auto& [object, ellipsoid] : result.ellipsoids) {
    if (map.objects().Contains(object)) {
      map.MutableObject(object).ellipsoid = ellipsoid;
    }
  }
}

}  // namespace hullslam
