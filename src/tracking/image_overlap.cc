// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/image_overlap.h"

#include <cstddef>
#include <vector>

namespace hullslam {

double ShareInImage(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                    std::span<const LandmarkId> landmarks) {
  size_t count = 0;
  size_t inside = 0;
  for (const LandmarkId id : landmarks) {
    const Landmark* const landmark = id.IsValid() ? map.landmarks().Find(id) : nullptr;
    if (landmark == nullptr) {
      continue;
    }
    ++count;
    const Eigen::Vector3d point = cam_from_world * landmark->position;
    const bool is_inside = point.z() > 0.0 && sensor.Sees(sensor.camera.Project(point));
    inside += is_inside ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(inside) / static_cast<double>(count) : 1.0;
}

double NextOverlap(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                   KeyframeId reference, const LastFrame& last) {
  const std::vector<LandmarkId>& landmarks = map.keyframes().At(reference).landmarks;
  return ShareInImage(map, sensor, cam_from_world, landmarks) +
         ShareInImage(map, sensor, cam_from_world, last.landmarks) - 1.0;
}

}  // namespace hullslam
