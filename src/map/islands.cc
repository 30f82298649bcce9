// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/islands.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

#include "map/keyframe_graph.h"
#include "map/keyframe_order.h"

namespace hullslam {
namespace {

// The island with most keyframes of frames before `end`, culled ones included; ties go to the
// oldest island. Invalid if there are no such keyframes.
IslandId LargestIsland(const Map& map, FrameId end) {
  std::map<IslandId, size_t> sizes;
  for (uint32_t i = 0; i < map.keyframes().NextId().value; ++i) {
    const IslandId island = IslandOf(map, KeyframeId(i));
    if (island.IsValid() && FrameIdOf(map, KeyframeId(i)) < end) {
      ++sizes[island];
    }
  }
  const auto largest = std::max_element(
      sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return largest != sizes.end() ? largest->first : IslandId();
}

void EraseEntities(Map& map, IslandId kept) {
  std::vector<LandmarkId> landmarks;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if (IslandOf(map, landmark.reference) != kept) {
      landmarks.push_back(id);
    }
  });
  std::vector<ObjectId> objects;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (IslandOf(map, object) != kept) {
      objects.push_back(id);
    }
  });
  std::for_each(landmarks.begin(), landmarks.end(), [&](LandmarkId id) { map.EraseLandmark(id); });
  std::for_each(objects.begin(), objects.end(), [&](ObjectId id) { map.EraseObject(id); });
}

}  // namespace

IslandId IslandOf(const Map& map, KeyframeId id) {
  const Keyframe* const keyframe = map.keyframes().Find(map.NearestAlive(id));
  return keyframe != nullptr ? keyframe->island : IslandId();
}

IslandId IslandOf(const Map& map, const ObjectLandmark& object) {
  return IslandOf(map, object.reference);
}

std::vector<IslandId> Islands(const Map& map) {
  std::vector<IslandId> islands;
  for (uint32_t i = 0; i < map.islands_begun(); ++i) {
    if (map.IslandSize(IslandId(i)) > 0) {
      islands.emplace_back(i);
    }
  }
  return islands;
}

std::vector<KeyframeId> KeyframesOf(const Map& map, IslandId island) {
  std::vector<KeyframeId> keyframes;
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (keyframe.island == island) {
      keyframes.push_back(id);
    }
  }
  return keyframes;
}

IslandId MainIsland(const Map& map) {
  const std::vector<IslandId> islands = Islands(map);
  if (islands.size() <= 1) {
    return islands.empty() ? IslandId() : islands.front();
  }
  const IslandId earlier =
      map.sessions().empty() ? IslandId() : LargestIsland(map, map.sessions().back().first_frame);
  return earlier.IsValid() ? earlier : LargestIsland(map, map.NextFrame());
}

void JoinIslands(Map& map, KeyframeId a, KeyframeId b) {
  const IslandId of_a = IslandOf(map, a);
  const IslandId of_b = IslandOf(map, b);
  if (of_a == of_b) {
    return;
  }
  const auto [kept, younger] = std::minmax(of_a, of_b);
  const auto [trunk, branch] = of_a == kept ? std::pair(a, b) : std::pair(b, a);
  MakeRoot(map, branch);
  SetParent(map, branch, trunk);
  for (const KeyframeId id : KeyframesOf(map, younger)) {
    map.MoveToIsland(id, kept);
  }
  map.CountJoinedIsland();
}

bool KeepOnlyIsland(Map& map, IslandId kept) {
  if (Islands(map).size() <= 1) {
    return false;
  }
  EraseEntities(map, kept);
  for (const IslandId island : Islands(map)) {
    if (island == kept) {
      continue;
    }
    for (const KeyframeId id : KeyframesOf(map, island)) {
      map.RemoveKeyframe(id);
    }
  }
  return true;
}

}  // namespace hullslam
