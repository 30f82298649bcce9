// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
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

// Keyframes that look like `query` although tracking does not connect them to it. A candidate is at
// least as similar to the query as the least similar of the query's covisible keyframes. The most
// similar candidate comes first. Among candidates that are covisible with each other, only the most
// similar one is listed. The map must have a vocabulary.
std::vector<LoopCandidate> FindLoopCandidates(const Map& map, KeyframeId query);

// Two visits to one place that tracking has connected by itself, because the drift was so small
// that it found landmarks of the earlier visit. Keyframes are in increasing order.
struct Return {
  KeyframeId query;                 // of the present visit
  KeyframeId candidate;             // of the earlier visit; shares most landmarks with the query
  std::vector<KeyframeId> present;  // the query and its covisible keyframes
  std::vector<KeyframeId> earlier;  // the candidate and its covisible keyframes
};

// The return that ends at the query. Null if there is none, or if a loop already joins the two
// visits. Between the visits there must be keyframes of this session from elsewhere, which
// covisibility does not connect to the query within two steps; without this condition a camera that
// begins in a loaded map, and has not drifted, would count as a return. The query must show
// `min_landmarks` landmarks of the earlier visit.
std::optional<Return> FindReturn(const Map& map, KeyframeId query, size_t min_landmarks);

// The merges of landmarks and objects that were mapped in both visits. Tracking and mapping find
// only landmarks that are within a few pixels of their expected position. So much of the place is
// in the map twice, and these copies do not constrain the visits relative to each other. No pose is
// corrected here; the adjustment of the whole map does that.
MapCorrection JoinVisits(const Map& map, const Sensor& sensor, const Return& found,
                         const FusionOptions& fusion);

}  // namespace hullslam
