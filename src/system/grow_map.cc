// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/grow_map.h"

#include <optional>
#include <utility>

#include "frame/measure_point.h"
#include "loop/island_join.h"
#include "map/islands.h"

namespace hullslam {
namespace {

bool AddLostKeyframes(Tracker& tracker, Mapper& mapper, const Cancellation* cancellation) {
  bool has_grown = false;
  while (!IsRequested(cancellation)) {
    std::optional<KeyframeRequest> request = tracker.FindLostKeyframe(mapper.Snapshot());
    if (!request) {
      break;
    }
    has_grown |= mapper.Process(std::move(*request), cancellation);
  }
  return has_grown;
}

bool JoinOnce(Mapper& mapper, const Sensor& sensor, const SystemOptions& options,
              const Cancellation* cancellation) {
  Map map = mapper.Snapshot();
  const IslandId main = MainIsland(map);
  for (const IslandId island : Islands(map)) {
    if (island == main) {
      continue;
    }
    for (const KeyframeId keyframe : KeyframesOf(map, island)) {
      if (IsRequested(cancellation)) {
        return false;
      }
      std::optional<MapCorrection> join = FindJoin(map, keyframe, WithWideErrors(sensor),
                                                   options.loop, options.objects, options.seed);
      if (join) {
        return mapper.Process(std::move(*join), cancellation);
      }
    }
  }
  return false;
}

}  // namespace

void GrowMap(Tracker& tracker, Mapper& mapper, const Sensor& sensor, const SystemOptions& options,
             const Cancellation* cancellation) {
  if (!tracker.HasHadWideSteps()) {
    return;
  }
  mapper.ExpectWideSteps(true);
  do {
    AddLostKeyframes(tracker, mapper, cancellation);
  } while (JoinOnce(mapper, sensor, options, cancellation));
}

}  // namespace hullslam
