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

// An object of the world that keyframes observe.
struct ObjectLandmark {
  ObjectState state = ObjectState::kCandidate;
  bool has_shape = false;  // whether the ellipsoids below are set
  Ellipsoid ellipsoid;     // world frame
  Ellipsoid start;         // what it was initialised as; holds what silhouettes leave free
  std::map<std::string, double> votes;          // sum of scores by class
  std::vector<ObjectObservation> observations;  // by increasing keyframe id, one a keyframe
  double misfit_px = 0.0;                       // RMS distance of its lines from the outline
  int visible = 0;  // frames in which it should have been seen since it was mapped
  int found = 0;    // frames in which it was

  // The class with most votes, the first in the alphabet of equals.
  const std::string& Label() const;
};

}  // namespace hullslam
