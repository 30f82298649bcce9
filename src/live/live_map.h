// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "live/live_inbox.h"
#include "live/row_table.h"
#include "view/view_model.h"

namespace hullslam {

// How much of a map a browser gets, so that large maps stay usable.
struct LiveMapLimits {
  size_t landmarks = 60000;     // more are thinned
  size_t objects = 1000;        // those that were seen last; a quarter more may wait for removal
  size_t covisibility = 20000;  // edges; those with fewest shared landmarks are left out first
  size_t changed_landmarks = 6000;  // in one change; the others follow in the next ones
  size_t changed_keyframes = 1500;
  double object_seconds = 0.02;  // time for measuring changed objects in one change
};

// The difference between the map that browsers have and a newer one.
struct LiveMapChange {
  RowChange landmarks;            // rows of LiveMap::landmarks()
  RowChange keyframes;            // rows of LiveMap::keyframes()
  std::vector<ObjectId> objects;  // those that were changed or added
  bool were_objects_removed = false;
  bool were_edges_changed = false;
};

// The part of a map that browsers show: the main island (map/islands.h), thinned if it is
// large. A landmark is shown once its distance is known (map/located_landmarks.h).
class LiveMap {
 public:
  static constexpr size_t kLandmarkWidth = 4;  // x, y, z (m, or units of the map), age (s)
  static constexpr size_t kKeyframeWidth = 8;  // time (s), pose: tx ty tz qx qy qz qw

  // Times are counted from `start`, s.
  LiveMap(const Sensor& sensor, double start, const LiveMapLimits& limits)
      : sensor_(sensor), start_(start), limits_(limits) {}

  // Follows the map. Without `is_limited`, all changes are made at once.
  LiveMapChange Follow(const Map& map, bool is_limited);

  const RowTable& landmarks() const { return landmarks_; }
  const RowTable& keyframes() const { return keyframes_; }
  const std::map<ObjectId, ObjectResult>& objects() const { return objects_; }
  const ViewEdges& edges() const { return edges_; }
  size_t landmark_total() const { return landmark_total_; }
  // Whether landmarks or objects are left out because there are too many.
  bool IsThinned() const { return landmark_total_ > limits_.landmarks || are_objects_left_out_; }

 private:
  RowChange FollowLandmarks(const Map& map, IslandId island, bool is_limited);
  RowChange FollowKeyframes(const Map& map, IslandId island, bool is_limited);
  std::map<ObjectId, const ObjectLandmark*> ChooseObjects(const Map& map, IslandId island);
  void FollowObjects(const Map& map, IslandId island, bool is_limited, LiveMapChange& change);
  bool FollowEdges(const Map& map, IslandId island);

  const Sensor sensor_;
  const double start_;
  const LiveMapLimits limits_;
  RowTable landmarks_{kLandmarkWidth, 3};
  RowTable keyframes_{kKeyframeWidth, kKeyframeWidth};
  std::map<ObjectId, ObjectResult> objects_;
  KeyframeId oldest_view_{0};  // objects that were only seen before are left out
  bool are_objects_left_out_ = false;
  ObjectId next_object_{0};  // at which the next measuring begins
  ViewEdges edges_;
  size_t landmark_total_ = 0;
  float tolerance_ = 0.0f;  // movements up to this are not sent, m or units of the map
};

}  // namespace hullslam
