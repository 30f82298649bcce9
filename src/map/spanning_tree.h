// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"

namespace hullslam {

void SetParent(Map& map, KeyframeId child, KeyframeId parent);

// Turns the tree of `keyframe` so that it becomes the root: the edges on the way to the former root
// change their direction.
void MakeRoot(Map& map, KeyframeId keyframe);

// Removes `keyframe` from the tree. Each of its children gets a new parent: of the parent of
// `keyframe` and the siblings that already have a new parent, the one that it shares most landmarks
// with. A child that shares none with them becomes a child of the parent of `keyframe`.
void DetachFromTree(Map& map, KeyframeId keyframe);

}  // namespace hullslam
