// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/drift_budget.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "map/islands.h"
#include "util/statistics.h"

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
    travel.length += (pose.translation - before.translation).norm();
    travel.radians += pose.rotation.angularDistance(before.rotation);
    before = pose;
  }
  return travel;
}

double MetreOf(const Map& map, KeyframeId id, const Sensor& sensor) {
  const Keyframe& keyframe = map.keyframes().At(id);
  std::vector<double> depths;
  for (const LandmarkId landmark : keyframe.landmarks) {
    if (landmark.IsValid()) {
      depths.push_back((keyframe.cam_from_world * map.landmarks().At(landmark).position).z());
    }
  }
  return sensor.IsMonocular() && !depths.empty() ? Median(std::move(depths)) : 1.0;
}

bool CanBeDrift(const Travel& travel, const Rigid3& tracked_cam_from_world,
                const Rigid3& corrected_cam_from_world, double metre, const LoopOptions& options) {
  const Rigid3 tracked = Inverse(tracked_cam_from_world);
  const Rigid3 corrected = Inverse(corrected_cam_from_world);
  const double metres = travel.length / metre;
  const double moved = (corrected.translation - tracked.translation).norm() / metre;
  const double turned = corrected.rotation.angularDistance(tracked.rotation);
  return moved <= options.drift_base + options.drift_per_metre * metres +
                      options.drift_per_radian * travel.radians &&
         turned <= options.turn_base + options.turn_per_metre * metres +
                       options.turn_per_radian * travel.radians;
}

}  // namespace hullslam
