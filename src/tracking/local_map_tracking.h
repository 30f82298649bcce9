// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The part of the map that a frame is tracked against.
struct LocalMap {
  KeyframeId reference;               // the keyframe that shares most landmarks with the frame
  std::vector<KeyframeId> keyframes;  // by increasing id
  std::vector<LandmarkId> landmarks;  // by increasing id
};

// Selects at most `max_keyframes` keyframes: first those that observe most of the given landmarks,
// then their neighbours in covisibility and spanning tree. If no keyframe observes any of the
// landmarks, `last_reference` is used instead of the observers. The landmarks of the local map are
// all landmarks that its keyframes observe.
LocalMap SelectLocalMap(const Map& map, std::span<const LandmarkId> landmarks,
                        KeyframeId last_reference, size_t max_keyframes);

// The largest radius within which a landmark of the local map is searched at its predicted pixel,
// px at level 0: 4 px (Mur-Artal and Tardos 2017), three times, because first poses and depths are
// less precise.
inline constexpr double kLocalSearchRadius = 12.0;

// A frame tracked against its local map.
struct LocalTracking {
  PoseEstimate estimate;
  // The keyframe that shares most landmarks with the frame; the last reference if none shares any.
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
