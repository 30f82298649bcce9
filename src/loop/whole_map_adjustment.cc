// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/whole_map_adjustment.h"

#include "optim/bundle_adjustment.h"

namespace hullslam {

std::optional<MapCorrection> AdjustWholeMap(const Map& map, const Sensor& sensor,
                                            const ObjectOptions& objects,
                                            const Cancellation* cancellation) {
  const WindowObjects in_window =
      objects.enabled && objects.bundle_adjustment ? WindowObjects::kMapped : WindowObjects::kNone;
  const BundleResult result =
      AdjustBundle(map, sensor, GlobalWindow(map, in_window),
                   BundleOptions{.objects = objects.bundle}.ForWholeMap(), cancellation);
  const bool is_cancelled = cancellation != nullptr && cancellation->IsRequested();
  if (!result.is_usable || is_cancelled) {
    return std::nullopt;
  }
  MapCorrection correction;
  correction.snapshot_corrections = map.correction_count();
  for (const auto& [id, pose] : result.poses) {
    correction.poses.push_back({id, map.keyframes().At(id).cam_from_world, Sim3(pose)});
  }
  for (const auto& [id, position] : result.positions) {
    correction.positions.push_back({id, position});
  }
  return correction;
}

}  // namespace hullslam
