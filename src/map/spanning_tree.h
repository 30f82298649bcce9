// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"

namespace hullslam {

void SetParent(Map& map, KeyframeId child, KeyframeId parent);

// Hands the children of `keyframe` to the keyframes they share most landmarks with among its parent
// and the siblings already handed over, else to its parent; then takes it out of the tree.
void DetachFromTree(Map& map, KeyframeId keyframe);

}  // namespace hullslam
