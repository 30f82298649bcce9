// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/util/id.h"

namespace hullslam {

struct Observation {
  KeyframeId keyframe;
  uint32_t keypoint = 0;  // index into the keyframe's features
};

// A point of the world that keyframes observe.
struct Landmark {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();           // m, world frame
  Eigen::Vector3d viewing_direction = Eigen::Vector3d::Zero();  // unit, mean of camera to landmark
  double min_distance = 0.0;              // m; nearer its patch is coarser than level 0 can tell
  double max_distance = 0.0;              // m; from here it is seen at level 0
  Descriptor descriptor{};                // the observed one that is nearest to all others
  std::vector<Observation> observations;  // by increasing keyframe id, one a keyframe
  KeyframeId reference;                   // the keyframe that level and distance refer to
  KeyframeId created_by;
  int support = 0;  // observations, those with depth counted twice
  int visible = 1;  // frames in which it should have been seen
  int found = 1;    // frames in which it was
};

}  // namespace hullslam
