// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace hullslam {

// Why an object is not mapped, or not any more.
enum class ObjectRejection {
  kFewKeyframes,    // fewer keyframes than needed
  kLittleParallax,  // the rays to it are nearly parallel
  kNoStart,         // too few depth points, or rays that do not meet
  kNotRefined,      // the solver failed
  kNotInFront,      // not in front of every camera that observes it
  kAxesOutOfRange,  // a half axis is too small or too large
  kLowOverlap,      // small mean IoU of projected ellipse and hull
  kOffPoints,       // too few depth points are inside it or near its surface
  kStretched,       // it reaches far beyond its depth points
  kLargeMisfit,     // its projected ellipses are far from its masks, for its size
  kElongated,       // long or flat along the view, which needs more parallax
  kPart,            // it is a part of a mapped object
  kSeldomSeen,      // culled, because few of the keyframes that should see it do
  kContradicted,    // later depth images show what is behind it
  kFused,           // it was the same as another object
};
inline constexpr int kObjectRejectionCount = 15;

// As in summary.json: "few_views".
std::string ToString(ObjectRejection reason);

}  // namespace hullslam
