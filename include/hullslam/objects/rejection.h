// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace hullslam {

// Why an object is not mapped, or is no longer.
enum class ObjectRejection {
  kFewViews,        // fewer keyframes than needed
  kLittleParallax,  // the rays to it are nearly parallel
  kNoStart,         // too few depth points, or rays that do not meet
  kNotRefined,      // the solver failed
  kNotInFront,      // of every camera that observes it
  kAxesOutOfRange,
  kLowOverlap,  // of outline and hulls
  kOffPoints,   // depth points are neither in it nor near its surface
  kStretched,   // it reaches far beyond its points
  kPart,        // of a mapped object
  kSeldomSeen,  // culled
  kFused,       // it was one with another object
};
inline constexpr int kObjectRejectionCount = 12;

// As in summary.json: "few_views".
std::string ToString(ObjectRejection reason);

}  // namespace hullslam
