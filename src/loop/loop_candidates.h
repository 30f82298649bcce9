// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"
#include "util/id_set.h"

namespace hullslam {

// A keyframe that looks like another one.
struct LoopCandidate {
  KeyframeId keyframe;
  // How many of the keyframes that are most covisible with the query look like the candidate or one
  // of its neighbours too. (Mur-Artal and Tardos 2017 ask for three queries in a row; this asks the
  // neighbours of one query, so that nothing has to be remembered.)
  int supporters = 0;
};

// The keyframes that tracking connects to one: it and everything within two steps of the
// covisibility graph.
IdSet<KeyframeId> ConnectedTo(const Map& map, KeyframeId keyframe);

// Keyframes that look like `query` although tracking does not connect them to it. A candidate is at
// least as similar to the query as the least similar of the query's covisible keyframes. The most
// similar comes first; of keyframes that are covisible with each other only the best is listed. The
// map must have a vocabulary.
std::vector<LoopCandidate> FindLoopCandidates(const Map& map, KeyframeId query);

}  // namespace hullslam
