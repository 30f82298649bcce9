// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// The inconsistencies of a map, one sentence per fault: observations, covisibility edges, loop
// edges or tree links that are stored at one end only, links from one island to another, wrong
// observation weights or votes, a cycle in the tree, a keyframe whose entries in the index are not
// its words, an object whose reference is not the first keyframe that observes it, a
// mapped object without observations, a detection of a keypoint that the frame does not have,
// values that are not finite. Empty for a consistent map.
std::vector<std::string> FindViolations(const Map& map);

}  // namespace hullslam
