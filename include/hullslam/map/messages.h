// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/frame/frame.h"
#include "hullslam/util/id.h"

namespace hullslam {

// What tracking learnt about a landmark since its last message.
struct Sighting {
  LandmarkId landmark;
  int visible = 0;
  int found = 0;
};

// From tracking to mapping: make a keyframe of this frame.
struct KeyframeRequest {
  std::shared_ptr<const Frame> frame;
  KeyframeId reference;  // invalid for the first keyframe: then the world is its camera frame
  Rigid3 cam_from_reference;
  std::vector<LandmarkId> landmarks;  // one a keypoint, invalid where there is none
  std::vector<Sighting> sightings;    // one a landmark
};

enum class TrackingState { kNotInitialized, kTracked, kLost };

// One line of the trajectory: the pose is relative, so that it follows the map's corrections.
struct TrackedFrame {
  FrameId frame;
  double timestamp = 0.0;
  TrackingState state = TrackingState::kNotInitialized;
  KeyframeId reference;  // invalid unless tracked; for the first keyframe its own
  Rigid3 cam_from_reference;
  Rigid3 cam_from_world;  // as it was when the frame was tracked
  int inliers = 0;        // landmarks found
};

}  // namespace hullslam
