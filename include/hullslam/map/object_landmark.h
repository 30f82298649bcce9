// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/util/id.h"

namespace hullslam {

enum class ObjectState {
  kCandidate,  // its shape is not known or not valid: it constrains nothing
  kMapped,     // its shape is valid in all its keyframes
};

// For messages and files: "candidate" or "mapped".
constexpr std::string_view ToString(ObjectState state) {
  return state == ObjectState::kMapped ? "mapped" : "candidate";
}

struct ObjectObservation {
  KeyframeId keyframe;
  uint32_t detection = 0;  // index into the frame's detections
};

// The distance by which the real object reaches beyond its quadric in one direction, measured by
// one line of one keyframe (misfit.h). An object keeps hundreds of samples, so they have
// single precision.
struct MisfitSample {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitX();  // outwards, object frame, unit
  float excess = 0.0f;                                // m; negative if it reaches less far
  KeyframeId keyframe;
};

// An object of the world that keyframes observe.
struct ObjectLandmark {
  ObjectState state = ObjectState::kCandidate;
  bool has_shape = false;               // whether the ellipsoids below are set
  Ellipsoid ellipsoid;                  // world frame
  Ellipsoid start;                      // the initial shape; centre of the prior in refinement
  std::map<std::string, double> votes;  // sum of scores by class
  std::vector<ObjectObservation> observations;  // by increasing keyframe id, one per keyframe
  // The keyframe with which a correction moves the object: the first one that observes it. It is
  // kept even if no observation is left, and may then be a culled keyframe.
  KeyframeId reference;
  size_t shaped_views = 0;      // number of observations when its shape was last computed
  double misfit_px = 0.0;       // RMS distance of its lines from its projected ellipses
  double compensated_px = 0.0;  // the same after misfit compensation
  std::vector<MisfitSample> misfit_samples;  // one per two-sided line of its latest keyframes
  int visible = 0;   // number of keyframes since it was mapped that found or should have shown it
  int found = 0;     // number of these that found it
  std::string name;  // given by a user; empty if there is none
  bool is_locked = false;   // by a user, see IsFixed()
  double known_size = 0.0;  // longest side (m), given by a user; 0 if it is not known

  // Whether nothing but a correction of the map around it changes the state, the shape and the
  // misfit of the object. It is not removed, unless by a user or with its island. A locked
  // candidate is mapped first.
  bool IsFixed() const { return is_locked && state == ObjectState::kMapped; }
  // Whether a text can be a name: at most 100 bytes of UTF-8 without control characters.
  static bool IsName(std::string_view text);
  // Whether a number can be a known size: from 0.001 to 100 m.
  static bool IsSize(double longest_side);
  // The class with most votes; ties go to the first in the alphabet.
  const std::string& Label() const;
};

}  // namespace hullslam
