// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"

namespace hullslam {

void SetParent(Map& map, KeyframeId child, KeyframeId parent);

// Removes `keyframe` from the tree. Each of its children gets a new parent: of the parent of
// `keyframe` and the siblings that already have a new parent, the one that it shares most landmarks
// with. A child that shares none with them becomes a child of the parent of `keyframe`.
void DetachFromTree(Map& map, KeyframeId keyframe);

}  // namespace hullslam
