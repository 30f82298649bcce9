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
  Eigen::Vector3d viewing_direction = Eigen::Vector3d::Zero();  // unit; mean from the cameras
  double min_distance = 0.0;              // m; at this distance it is seen at the last level
  double max_distance = 0.0;              // m; at this distance it is seen at level 0
  Descriptor descriptor{};                // the most typical of the observed ones
  std::vector<Observation> observations;  // by increasing keyframe id, one per keyframe
  KeyframeId reference;                   // the keyframe that the two distances are computed from
  KeyframeId created_by;
  int observation_weight = 0;  // number of observations; those with depth count twice
  int visible = 1;             // number of frames in which it should have been seen
  int found = 1;               // number of frames in which it was found
};

}  // namespace hullslam
