// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// The first function gives the island of a keyframe, which may be culled. The second one gives the
// island of an object, which is its reference keyframe's. Invalid if the keyframe has no pose
// (Map::NearestAlive).
IslandId IslandOf(const Map& map, KeyframeId keyframe);
IslandId IslandOf(const Map& map, const ObjectLandmark& object);

// The islands that have keyframes, by increasing number.
std::vector<IslandId> Islands(const Map& map);

// The keyframes of an island, without culled ones, by increasing id.
std::vector<KeyframeId> KeyframesOf(const Map& map, IslandId island);

// The island that stays when a run ends. It is the island with most keyframes, culled ones
// included; ties go to the oldest. If the map has keyframes of earlier sessions, only these are
// counted, because the run must not remove the work of earlier sessions. (A map can be saved while
// it has several islands.) Invalid for an empty map.
IslandId MainIsland(const Map& map);

// Joins the islands of two keyframes. The younger island gets the number of the older one, and its
// spanning tree becomes a branch of the other tree, connected by the given keyframes. Does nothing
// if the keyframes already belong to one island. Poses are not changed; the two islands must
// already have the same world frame.
void JoinIslands(Map& map, KeyframeId a, KeyframeId b);

// Removes all islands but one, with their keyframes, landmarks and objects. Removed keyframes, and
// all that has a pose relative to them, have no pose afterwards. Returns whether there were others.
bool KeepOnlyIsland(Map& map, IslandId kept);

}  // namespace hullslam
