// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The largest radius within which a landmark of the local map is searched at its predicted pixel,
// px at level 0: 4 px (Mur-Artal and Tardos 2017), three times, because first poses and depths are
// less precise.
inline constexpr double kLocalSearchRadius = 12.0;

// A frame tracked against its local map.
struct LocalTracking {
  PoseEstimate estimate;
  // The keyframe that shares most landmarks with the frame, or the last reference if none shares
  // any.
  KeyframeId reference;
  std::vector<ObjectId> objects;    // one per detection; invalid where it shows no mapped object
  std::vector<LandmarkId> visible;  // landmarks that should be in the image, found or not
  // Number of detections that show no mapped object; 0 if tracking.keyframes_for_objects is off.
  int unknown_objects = 0;
};

// Improves a first pose: searches the landmarks of the local map in the frame, then those on mapped
// objects that the local map lacks (objects.guided_matching), and optimises the pose with all
// landmarks found and all mapped objects (objects.joint_pose). `last_reference` is the reference
// keyframe of the last frame. It determines the local map if the first pose comes without
// landmarks.
LocalTracking TrackLocalMap(const Frame& frame, const Map& map, const TrackingContext& context,
                            KeyframeId last_reference, PoseEstimate start);

// Optimises the pose again with other measurements: `frame` has the same keypoints and detections
// as the one that was tracked, but at other pixels.
void RefineTracking(const Frame& frame, const Map& map, const TrackingContext& context,
                    LocalTracking& tracking);

}  // namespace hullslam
