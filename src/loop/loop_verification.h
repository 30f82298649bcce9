// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/sim3.h"
#include "hullslam/loop/loop_options.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Two keyframes that see the same place although tracking did not lead from one to the other.
struct Loop {
  KeyframeId query;      // the newer one
  KeyframeId candidate;  // the older one
  // Between the camera frames. The unit of length of each is that of the map at this keyframe.
  Sim3 query_from_candidate;
  // Keypoints of the query and the landmarks around the candidate that they show.
  struct Sighting {
    uint32_t keypoint = 0;
    LandmarkId landmark;
  };
  std::vector<Sighting> sightings;
};

// The loop, or the reason why there is none.
struct LoopVerdict {
  std::optional<Loop> loop;
  std::string refusal;  // empty if there is a loop
};

// Whether a candidate really shows the query's place. Landmarks are matched by words, a similarity
// is found by RANSAC and refined while more landmarks are found with it (Mur-Artal and Tardos 2014
// and 2017), and then the landmarks around the candidate are searched in the query. `fix_scale`: the
// similarity has scale 1, as in RGB-D. `seed` is that of the run.
LoopVerdict VerifyLoop(const Map& map, const Sensor& sensor, const Vocabulary& vocabulary,
                       KeyframeId query, KeyframeId candidate, bool fix_scale, uint64_t seed,
                       const LoopOptions& options);

// Searches landmarks in a keyframe whose camera is at `cam_from_world`, which may differ from the
// pose in the map. What is found agrees with the keypoint to OutlierBound.
std::vector<Loop::Sighting> FindLandmarks(const Map& map, const Sensor& sensor, KeyframeId keyframe,
                                          const Rigid3& cam_from_world,
                                          const std::vector<LandmarkId>& landmarks);

}  // namespace hullslam
