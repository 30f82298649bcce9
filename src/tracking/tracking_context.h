// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include "hullslam/frame/sensor.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/tracking/tracking_options.h"
#include "objects/object_index.h"

namespace hullslam {

// The data that every step of tracking needs besides the frame and the map. The references must
// outlive this struct.
struct TrackingContext {
  const Sensor& sensor;
  const TrackingOptions& options;
  const ObjectOptions& objects;
  const ObjectIndex& object_index;  // index of the objects of the map
  uint64_t seed = 0;                // seed of the run
  bool is_wide = false;             // `sensor` is WithWideErrors

  // The bounds of Mur-Artal and Tardos 2017 as shares of tracking.min_inliers. With its default of
  // 30, the motion model needs 20 matches, the reference keyframe 15 matches, a first pose 10
  // inliers, and a relocalised frame 50 inliers.
  size_t min_motion_matches() const { return static_cast<size_t>(options.min_inliers) * 2 / 3; }
  size_t min_reference_matches() const { return static_cast<size_t>(options.min_inliers) / 2; }
  int min_start_inliers() const { return options.min_inliers / 3; }
  int min_relocalisation_inliers() const { return options.min_inliers * 5 / 3; }
};

}  // namespace hullslam
