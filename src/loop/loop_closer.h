// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hullslam/frame/sensor.h"
#include "hullslam/loop/loop_options.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "loop/loop_candidates.h"
#include "loop/loop_verification.h"
#include "loop/object_votes.h"

namespace hullslam {

// A snapshot of the map for the loop closer alone, and the keyframe at which it searches a loop.
struct LoopQuery {
  Map map;
  KeyframeId keyframe;
};

// Finds loops in snapshots of the map and computes the corrections that close them. A loop whose
// ends belong to different islands joins the islands. The loop closer does not change the map; it
// sends corrections to the mapper, which drops them if the map was corrected since the snapshot.
// Such a loop is sought again.
class LoopCloser {
 public:
  // `sensor` must outlive the loop closer. `seed` is the run's.
  LoopCloser(const Sensor& sensor, const LoopOptions& options, const ObjectOptions& objects,
             uint64_t seed);

  // Looks for a loop at the keyframe of the query. Null if there is none. Maps without a vocabulary
  // have no loops.
  std::optional<MapCorrection> Process(LoopQuery query);

 private:
  // The correction of the last loop that was found, until the mapper has processed it.
  struct SentLoop {
    MapCorrection::LoopEdge edge;
    uint32_t snapshot_corrections = 0;
    KeyframeId former_loop;  // last_loop_ before it
  };
  void Remember(KeyframeId query, const MapCorrection& correction);
  void CheckSentLoop(const Map& map);
  std::optional<MapCorrection> Close(LoopQuery& query, const LoopCandidate& candidate,
                                     std::string& refusal) const;

  // Merges landmarks and objects that were mapped twice, if tracking has recognised the place of
  // the query by itself.
  std::optional<MapCorrection> JoinReturn(const LoopQuery& query);
  std::string FindTooMuchDrift(const Map& map, const Loop& loop) const;
  size_t LandmarksNeeded(const LoopCandidate& candidate, const ObjectVotes& votes) const;

  const Sensor& sensor_;
  const LoopOptions options_;
  const ObjectOptions object_options_;
  const uint64_t seed_;
  KeyframeId last_loop_;  // the newer end of the loop that was closed last
  std::optional<SentLoop> sent_;
};

}  // namespace hullslam
