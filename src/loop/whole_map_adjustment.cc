// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/whole_map_adjustment.h"

#include <algorithm>

#include "map/islands.h"
#include "optim/bundle_adjustment.h"

namespace hullslam {
namespace {

void Append(const Map& map, const BundleResult& result, MapCorrection& correction) {
  for (const auto& [id, pose] : result.poses) {
    correction.poses.push_back({id, map.keyframes().At(id).cam_from_world, Sim3(pose)});
  }
  for (const auto& [id, position] : result.positions) {
    correction.positions.push_back({id, position});
  }
}

}  // namespace

std::optional<MapCorrection> AdjustWholeMap(const Map& map, const Sensor& sensor,
                                            const ObjectOptions& objects,
                                            const Cancellation* cancellation) {
  MapCorrection correction;
  correction.snapshot_corrections = map.correction_count();
  bool is_adjusted = false;
  for (const IslandId island : Islands(map)) {
    const BundleResult result = AdjustIsland(map, island, sensor, objects, cancellation).result;
    if (result.is_usable) {
      Append(map, result, correction);
      is_adjusted = true;
    }
  }
  if (!is_adjusted || IsRequested(cancellation)) {
    return std::nullopt;
  }
  std::sort(correction.poses.begin(), correction.poses.end(),
            [](const auto& a, const auto& b) { return a.keyframe < b.keyframe; });
  return correction;
}

}  // namespace hullslam
