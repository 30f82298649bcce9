// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/detection.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/map/object_landmark.h"

namespace hullslam {

// The direction, the size and, with depth, the distance of an object in the camera frame, as its
// detection shows them.
struct ObjectSighting {
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();  // unit, through the hull's centre, camera frame
  // Half axes of the ellipse with the area moments of the hull, the larger one first, over the
  // depth (z) of the object.
  Eigen::Vector2d half_axes = Eigen::Vector2d::Zero();
  double surface = 0.0;  // m, mean distance of the depth points along the ray; 0 without depth
};

// Null if the image cuts the mask or if the hull has no area, because its centre and size are then
// not those of the object.
std::optional<ObjectSighting> SightObject(const PinholeCamera& camera, const Detection& detection);

// The distance along the ray (m) at which the centre of an ellipsoid is if the sighting shows it;
// the sighting must have depth. For parallel rays, the mean length of an ellipsoid along the rays
// is its volume over the area of its silhouette, and half of this length is in front of the centre.
// So the rotation of the ellipsoid need not be known.
double DistanceOfCenter(const ObjectSighting& sighting, const Eigen::Vector3d& half_axes);

// Whether an ellipsoid with these half axes (m) may look as large as the sighting from the distance
// (m) along its ray. The half axes x >= y of the silhouette are between those of the ellipsoid,
// c >= x >= b >= y >= a. The bounds are generous, because no object is an ellipsoid.
bool MayHaveSize(const ObjectSighting& sighting, double distance, const Eigen::Vector3d& half_axes);

// Whether the class has a sufficient share of the object's votes.
bool MayHaveClass(const ObjectLandmark& object, const std::string& label);

}  // namespace hullslam
