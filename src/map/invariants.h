// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// What is wrong with a map, one sentence per fault: observations known at one end only, support or
// votes miscounted, covisibility, loop edges or tree links known at one end only, a cycle in the
// tree, an object whose reference is not the first keyframe that observes it, values that are not
// finite. Empty for a sound map.
std::vector<std::string> FindViolations(const Map& map);

}  // namespace hullslam
