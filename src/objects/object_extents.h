// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/map/map.h"
#include "objects/resolved_observation.h"

namespace hullslam {

// The size of an object.
struct ObjectExtents {
  // Lengths of the sides of the box around the object, the shortest first, in the unit of the map.
  Eigen::Vector3d sides = Eigen::Vector3d::Zero();
  double misfit = 0.0;  // RMS distance of the tangent planes from the body, over the longest side
};

// Measures an object by the two-sided lines of its observations: each is the image of a plane that
// touches it (misfit.h). Lines near the border of the image are left out, because networks
// end masks some pixels before it. The axes of the quadric are not the sides of the object: the
// ellipsoid that fits the silhouettes of a box best is longer than the box where the corners show.
// For the keyboard of freiburg1_xyz the longest axis is wrong by 16 %. So two bodies are fitted to
// the planes, a box with the support function sum_i h_i |n_i| and an ellipsoid with sqrt(sum_i (h_i
// n_i)^2), where h are the half sides and n is the normal in the frame of the body; position and
// rotation are free. The body that fits better is chosen. Nothing if there are too few planes or if
// neither body fits.
std::optional<ObjectExtents> MeasureExtents(const Sensor& sensor, const Ellipsoid& ellipsoid,
                                            std::span<const ResolvedObservation> observations);

// The unit of length of a map, measured by objects of known size.
struct KnownScale {
  size_t objects = 0;  // mapped objects of known size that could be measured
  // The median over these objects, each of which counts as often as it was observed; 1 without such
  // objects.
  double metres_per_unit = 1.0;
};

// The known length of the longest side of a mapped object, m: its own, or else that of its class
// (the one with most votes) in `sizes`. 0 if neither is known, and for a candidate.
double KnownSize(const ObjectLandmark& object, const std::map<std::string, double>& sizes);

// Compares the known sizes with the longest sides that MeasureExtents finds.
KnownScale MeasureScale(const Map& map, const Sensor& sensor,
                        const std::map<std::string, double>& sizes);

}  // namespace hullslam
