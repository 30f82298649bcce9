// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/util/id.h"

namespace hullslam {

enum class ObjectState {
  kCandidate,  // seen, but its shape is not held yet: it constrains nothing
  kMapped,     // valid in all its keyframes
};

struct ObjectObservation {
  KeyframeId keyframe;
  uint32_t detection = 0;  // index into the frame's detections
};

// By how much the real object reaches beyond its quadric in one direction, as measured by one line
// of a keyframe's outline (objects/misfit.h).
struct MisfitSample {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // outwards, object frame, unit
  double excess = 0.0;                                // m; negative where it is smaller
  KeyframeId keyframe;
};

// An object of the world that keyframes observe.
struct ObjectLandmark {
  ObjectState state = ObjectState::kCandidate;
  bool has_shape = false;  // whether the ellipsoids below are set
  Ellipsoid ellipsoid;     // world frame
  Ellipsoid start;         // what it was initialised as; holds what silhouettes leave free
  std::map<std::string, double> votes;          // sum of scores by class
  std::vector<ObjectObservation> observations;  // by increasing keyframe id, one a keyframe
  size_t shaped_views = 0;                      // when its shape was last sought or refined
  double misfit_px = 0.0;                       // RMS distance of its lines from the outline
  double compensated_px = 0.0;                  // the same, less what other keyframes predict
  std::vector<MisfitSample> misfit_samples;     // one per line of its latest keyframes
  int visible = 0;  // frames in which it should have been seen since it was mapped
  int found = 0;    // frames in which it was

  // The class with most votes, the first in the alphabet of equals.
  const std::string& Label() const;
};

}  // namespace hullslam
