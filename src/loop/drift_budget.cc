// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/drift_budget.h"

#include <algorithm>
#include <cmath>

#include "map/islands.h"

namespace hullslam {

Travel TravelBetween(const Map& map, KeyframeId first, KeyframeId last) {
  Travel travel;
  const auto [from, to] = std::minmax(first.value, last.value);
  const IslandId island = IslandOf(map, KeyframeId(from));
  Rigid3 before = Inverse(map.CamFromWorld(KeyframeId(from)));
  for (uint32_t i = from + 1; i <= to; ++i) {
    if (IslandOf(map, KeyframeId(i)) != island) {
      continue;
    }
    const Rigid3 pose = Inverse(map.CamFromWorld(KeyframeId(i)));
    travel.metres += (pose.translation - before.translation).norm();
    travel.radians += pose.rotation.angularDistance(before.rotation);
    before = pose;
  }
  return travel;
}

bool CanBeDrift(const Travel& travel, const Rigid3& tracked_cam_from_world,
                const Rigid3& corrected_cam_from_world, const LoopOptions& options) {
  const Rigid3 tracked = Inverse(tracked_cam_from_world);
  const Rigid3 corrected = Inverse(corrected_cam_from_world);
  const double moved = (corrected.translation - tracked.translation).norm();
  const double turned = corrected.rotation.angularDistance(tracked.rotation);
  return moved <= options.drift_base + options.drift_per_metre * travel.metres +
                      options.drift_per_radian * travel.radians &&
         turned <= options.turn_base + options.turn_per_metre * travel.metres +
                       options.turn_per_radian * travel.radians;
}

}  // namespace hullslam
