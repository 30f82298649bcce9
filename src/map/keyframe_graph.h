// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// The two graphs of the keyframes of an island: the spanning tree and covisibility.

// Makes `parent` the parent of `child` in the spanning tree, in place of its former one.
void SetParent(Map& map, KeyframeId child, KeyframeId parent);

// Makes `keyframe` the root of its tree: the edges on the path to the former root change their
// direction.
void MakeRoot(Map& map, KeyframeId keyframe);

// Removes `keyframe` from the tree. Each of its children gets a new parent, chosen from the parent
// of `keyframe` and the siblings that already have a new parent: the one that shares most landmarks
// with the child. If none shares a landmark, it is the parent of `keyframe`.
void DetachFromTree(Map& map, KeyframeId keyframe);

// Counts the landmarks that `keyframe` shares with others and updates its edges at both ends. An
// edge needs 15 shared landmarks. If no other keyframe shares that many, the one that shares most
// gets an edge. A keyframe without parent becomes the child of the older keyframe that it shares
// most with.
void UpdateCovisibility(Map& map, KeyframeId keyframe);

// Whether edges of 15 or more shared landmarks lead from one keyframe to the other. True if the
// frame of `a` has no motion prior, because only dead reckoning makes keyframes without edges.
bool AreConnected(const Map& map, KeyframeId a, KeyframeId b);

// Whether no such edges lead to the parent, as of a keyframe that was dead reckoned: only the poses
// at that time tie the keyframe to its parent.
bool IsTied(const Map& map, KeyframeId keyframe);

// Removes all edges of `keyframe`.
void DetachCovisibility(Map& map, KeyframeId keyframe);

// At most `count` covisible keyframes, by decreasing number of shared landmarks, then id.
std::vector<KeyframeId> BestCovisible(const Keyframe& keyframe, size_t count);

// The keyframes that observe any of the landmarks, which need not exist, with the number that each
// of them observes: by decreasing number, then by increasing id.
std::vector<Covisible> CountObservers(const Map& map, std::span<const LandmarkId> landmarks);

// The landmarks that any of the keyframes observes, by increasing id.
std::vector<LandmarkId> ObservedLandmarks(const Map& map, std::span<const KeyframeId> keyframes);

}  // namespace hullslam
