// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_result.h"

#include <algorithm>
#include <cmath>

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

void KeepScale(const Map& map, KeyframeId fixed, BundleResult& result) {
  const Eigen::Vector3d center = Inverse(map.CamFromWorld(fixed)).translation;
  double before = 0.0;
  double after = 0.0;
  for (const auto& [keyframe, cam_from_world] : result.poses) {
    before += (Inverse(map.CamFromWorld(keyframe)).translation - center).norm();
    after += (Inverse(cam_from_world).translation - center).norm();
  }
  const double scale = before / after;
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    return;  // all cameras are at the same position
  }
  const auto move = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return center + scale * (point - center);
  };
  for (auto& [keyframe, cam_from_world] : result.poses) {
    const Eigen::Vector3d moved = move(Inverse(cam_from_world).translation);
    cam_from_world.translation = -(cam_from_world.rotation * moved);
  }
  for (auto& [landmark, position] : result.positions) {
    position = move(position);
  }
  for (auto& [object, ellipsoid] : result.ellipsoids) {
    ellipsoid.world_from_object.translation = move(ellipsoid.world_from_object.translation);
    ellipsoid.half_axes *= scale;
  }
}

}  // namespace hullslam
