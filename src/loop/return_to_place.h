// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// Two visits to one place that tracking has connected by itself, because it had drifted so little
// that it found landmarks of the earlier visit. Keyframes are in increasing order.
struct Return {
  KeyframeId query;                 // of the present visit
  KeyframeId candidate;             // of the earlier one: shares most landmarks with the query
  std::vector<KeyframeId> present;  // the query and what is covisible with it
  std::vector<KeyframeId> earlier;  // the candidate and what is covisible with it
};

// The return that has led to the keyframe. Null if there is none, or if a loop joins the two visits
// already. Between them there must be keyframes of this session from elsewhere, which covisibility
// does not connect to the query within two steps: a camera that begins in a loaded map has not
// drifted. The query must show `min_landmarks` landmarks of the earlier one.
std::optional<Return> FindReturn(const Map& map, KeyframeId query, size_t min_landmarks);

// The merges of what is one thing although it was mapped in both visits. Tracking and mapping find
// only landmarks that are within few pixels of where they should be, so much of the place stays in
// the map twice and does not hold the visits together. No pose is corrected: that is left to the
// adjustment of the whole map.
MapCorrection JoinVisits(const Map& map, const Sensor& sensor, const Return& found,
                         const FusionOptions& fusion);

}  // namespace hullslam
