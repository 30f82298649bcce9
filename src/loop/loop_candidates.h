// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// Keyframes that look like `query` although tracking does not connect them to it: no path of two
// steps in the covisibility graph leads from one to the other. The most similar comes first; of
// keyframes that are covisible with each other only the best is listed.
//
// A candidate is at least as similar to the query as the least similar of the query's covisible
// keyframes, and at least `min_supporters` of the keyframes that are most covisible with the query
// also look like the candidate or one of its neighbours (Mur-Artal and Tardos 2017 ask for three
// queries in a row; this asks the neighbours of one query, so that nothing has to be remembered).
// The map must have a vocabulary.
std::vector<KeyframeId> FindLoopCandidates(const Map& map, KeyframeId query, int min_supporters);

}  // namespace hullslam
