// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"
#include "util/id_set.h"

namespace hullslam {

// A keyframe that looks like another one.
struct LoopCandidate {
  KeyframeId keyframe;
  // The number of keyframes, among those that are most covisible with the query, that also look
  // like the candidate or one of its neighbours. (Mur-Artal and Tardos 2017 ask for three queries
  // in a row. Asking the neighbours of one query needs no memory of earlier queries.)
  int supporters = 0;
};

// The keyframes that tracking connects to a keyframe: the keyframe itself and all keyframes within
// two steps of the covisibility graph.
IdSet<KeyframeId> ConnectedTo(const Map& map, KeyframeId keyframe);

// Keyframes that look like `query` although tracking does not connect them to it. A candidate is at
// least as similar to the query as the least similar of the query's covisible keyframes. The most
// similar candidate comes first. Among candidates that are covisible with each other, only the most
// similar one is listed. The map must have a vocabulary.
std::vector<LoopCandidate> FindLoopCandidates(const Map& map, KeyframeId query);

}  // namespace hullslam
