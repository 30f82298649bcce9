// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"

namespace hullslam {

void SetParent(Map& map, KeyframeId child, KeyframeId parent);

// Makes `keyframe` the root of its tree: the edges on the path to the former root change their
// direction.
void MakeRoot(Map& map, KeyframeId keyframe);

// Removes `keyframe` from the tree. Each of its children gets a new parent, chosen from the parent
// of `keyframe` and the siblings that already have a new parent: the one that shares most landmarks
// with the child. If none shares a landmark, it is the parent of `keyframe`.
void DetachFromTree(Map& map, KeyframeId keyframe);

}  // namespace hullslam
