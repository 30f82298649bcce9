// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "map/correction.h"
#include "map/keyframe_graph.h"
#include "map/made_correction.h"
#include "support/ring_world.h"

namespace hullslam {

// Makes an island of the keyframes of a ring from `first` on, as if tracking had been lost there:
// landmarks that keyframes of both parts observe are erased. The island has a world and a unit of
// length of its own: island_from_world.
inline void SplitRing(RingMap& made, uint32_t first, const Sim3& island_from_world) {
  Map& map = made.map;
  std::vector<LandmarkId> common;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if (landmark.observations.front().keyframe.value < first &&
        landmark.observations.back().keyframe.value >= first) {
      common.push_back(id);
    }
  });
  for (const LandmarkId id : common) {
    map.EraseLandmark(id);
  }
  const IslandId island = map.BeginIsland();
  const auto count = static_cast<uint32_t>(made.views.size());
  for (uint32_t i = first; i < count; ++i) {
    map.MoveToIsland(KeyframeId(i), island);
    SetParent(map, KeyframeId(i), KeyframeId());
  }
  for (uint32_t i = 0; i < count; ++i) {
    UpdateCovisibility(map, KeyframeId(i));
  }
  MapCorrection move = MakeCorrection(map, island_from_world);
  move.poses.erase(move.poses.begin(), move.poses.begin() + first);
  ApplyCorrection(map, move, SharedRing().sensor().levels);
}

}  // namespace hullslam
