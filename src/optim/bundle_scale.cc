// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_scale.h"

#include <cmath>

namespace hullslam {

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
