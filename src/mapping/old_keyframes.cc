// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/old_keyframes.h"

#include "map/compaction.h"
#include "map/keyframe_order.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr uint32_t kYoungKeyframes = 20;

// The keyframe, those that are covisible with it, and those that are covisible with one of them.
IdSet<KeyframeId> NearKeyframes(const Map& map, KeyframeId id) {
  IdSet<KeyframeId> near;
  near.Insert(id);
  for (const Covisible& neighbour : map.keyframes().At(id).covisible) {
    near.Insert(neighbour.keyframe);
    for (const Covisible& second : map.keyframes().At(neighbour.keyframe).covisible) {
      near.Insert(second.keyframe);
    }
  }
  return near;
}

}  // namespace

void CompactOldKeyframes(Map& map, KeyframeId current, std::vector<KeyframeId>& full) {
  const IdSet<KeyframeId> near = NearKeyframes(map, current);
  std::erase_if(full, [&](KeyframeId id) {
    if (!map.keyframes().Contains(id)) {
      return true;
    }
    if (AgeOf(map, id, current, kYoungKeyframes + 1) <= kYoungKeyframes || near.Contains(id)) {
      return false;
    }
    CompactKeyframe(map, id);
    return true;
  });
}

}  // namespace hullslam
