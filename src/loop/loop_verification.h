// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/sim3.h"
#include "hullslam/loop/loop_options.h"
#include "hullslam/map/map.h"
#include "places/landmark_search.h"

namespace hullslam {

// Two keyframes that see the same place although tracking did not lead from one to the other.
struct Loop {
  KeyframeId query;      // the newer end
  KeyframeId candidate;  // the older end
  // Between the camera frames. Each has the unit of length of the map at this keyframe.
  Sim3 query_from_candidate;
  // The landmarks around the candidate that were found in the query, with their keypoints.
  std::vector<FoundLandmark> landmarks;
};

// The loop, or the reason why there is none.
struct LoopVerdict {
  std::optional<Loop> loop;
  std::string refusal;  // empty if there is a loop
};

// Checks whether a candidate really shows the query's place. Landmarks are matched by words. RANSAC
// finds a similarity, which is refined while more landmarks are found with it (Mur-Artal and Tardos
// 2014 and 2017). Then the landmarks around the candidate are searched in the query. `fix_scale`:
// the similarity has scale 1, as in RGB-D. `seed` is the run's. The map must have a
// vocabulary.
LoopVerdict VerifyLoop(const Map& map, const Sensor& sensor, KeyframeId query, KeyframeId candidate,
                       bool fix_scale, uint64_t seed, const LoopOptions& options);

// The same with other first matches: landmarks of the candidate and the keypoints of the query that
// seem to show them. Keypoints without a landmark of their own are left out.
LoopVerdict VerifyLoop(const Map& map, const Sensor& sensor, KeyframeId query, KeyframeId candidate,
                       std::span<const FoundLandmark> matches, bool fix_scale, uint64_t seed,
                       const LoopOptions& options);

// The length of a camera's path and the sum of its rotations.
struct Travel {
  double length = 0.0;  // in units of the map
  double radians = 0.0;
};

// The travel between two keyframes of one island along the shortest way: from each keyframe, also a
// culled one, to the one that was made before or after it, or over a closed loop. A map drifts
// along this way only: it is no longer wrong by what the camera has drifted before a loop.
// Keyframes of other islands are skipped.
Travel TravelBetween(const Map& map, KeyframeId first, KeyframeId last);

// The length, in units of the map, that the options mean by a metre. A map with depth has the metre
// as its unit. A map without depth has any unit, so the depth of the scene is used instead: the
// median depth of the landmarks that the keyframe observes.
double MetreOf(const Map& map, KeyframeId keyframe, const Sensor& sensor);

// Whether drift along this way can explain the difference between the tracked pose of a camera and
// its pose by a loop. `metre` is a length in units of the map (MetreOf).
bool CanBeDrift(const Travel& travel, const Rigid3& tracked_cam_from_world,
                const Rigid3& corrected_cam_from_world, double metre, const LoopOptions& options);

}  // namespace hullslam
