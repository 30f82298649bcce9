// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "objects/resolved_observation.h"

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

// Why a quadric is not valid for the observations of its object, with the measured value.
struct Objection {
  ObjectRejection reason = ObjectRejection::kFewKeyframes;
  std::string detail;  // "mean IoU 0.31, expected at least 0.40"
};

// The largest distance from the surface at which a point outside a quadric counts as near it.
// `distance` is the mean distance of the quadric from the cameras. Both in units of the map.
double NearSurface(const Ellipsoid& ellipsoid, double distance, const ValidityOptions& options);

// Checks, in this order: the quadric is in front of every camera; the half axes are in their range;
// the mean IoU of projected ellipse and hull is large enough; the misfit is not too large for the
// size of the masks; the parallax is large enough for its elongation; and with depth: enough points
// are inside or near the surface, and no half axis reaches far beyond the points. Returns nothing
// for a valid quadric. Needs at least one observation.
std::optional<Objection> FindObjection(const Ellipsoid& ellipsoid, const Sensor& sensor,
                                       std::span<const ResolvedObservation> observations,
                                       const ValidityOptions& options);

// Let q be the extent of a quadric along the mean viewing direction over its extent across it. The
// elongation is the larger one of q and 1 / (4 q) (ValidityOptions::max_elongation). It is at least
// 0.5.
double Elongation(const Ellipsoid& ellipsoid, std::span<const ResolvedObservation> observations);

// Mean over the observations of the IoU of hull and projected ellipse, which is clipped to the
// image. If the mask is a box, the bounding boxes are compared. An observation counts as 0 if the
// ellipsoid is not in front of its camera.
double MeanOverlap(const Ellipsoid& ellipsoid, const Sensor& sensor,
                   std::span<const ResolvedObservation> observations);

}  // namespace hullslam
