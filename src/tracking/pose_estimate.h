// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/util/id.h"

namespace hullslam {

// The pose of a frame, with the landmarks that were found in the frame.
struct PoseEstimate {
  // An object that constrains a pose counts as this many landmarks.
  static constexpr int kLandmarksPerObject = 5;

  Rigid3 cam_from_world;
  std::vector<LandmarkId> landmarks;  // one per keypoint; invalid where it shows no landmark
  int inliers = 0;                    // landmarks that agree with the pose
  int used_objects = 0;               // objects that constrain the pose
  // A keyframe that shows the same place as the frame; invalid if the landmarks determine the
  // place.
  KeyframeId keyframe_of_place;

  // The number of landmarks that would constrain the pose as much as the landmarks and objects do.
  int EffectiveInliers() const { return inliers + kLandmarksPerObject * used_objects; }
};

}  // namespace hullslam
