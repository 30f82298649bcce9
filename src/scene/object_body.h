// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/map/object_landmark.h"
#include "objects/resolved_observation.h"
#include "scene/scene.h"

namespace hullslam {

// The direction with this index (from 0) of `count` unit vectors that are evenly spread over the
// sphere: a Fibonacci lattice. The first half of them has z > 0.
Eigen::Vector3d SphereDirection(int index, int count);

// The distance of the tangent plane of an ellipsoid with the given outward normal from the origin.
double SupportOf(const Ellipsoid& ellipsoid, const Eigen::Vector3d& normal);

// The space that an object takes up, in an upright frame; relations are computed from it. This
// frame has the origin and the unit of the world, and z upwards.
struct ObjectBody {
  ObjectId id;
  Ellipsoid ellipsoid;  // upright frame
  // The outline of the object seen from above: convex, of positive signed area, m.
  std::vector<Eigen::Vector2d> footprint;
  double bottom = 0.0;  // m, along z
  double top = 0.0;
  // Whether its lower side was seen. If the border of the image or something nearer always cut it
  // off, the object may reach farther down than `bottom`.
  bool is_bottom_seen = true;
  double size = 0.0;          // m, mean of the three extents of its upright box
  double height_sigma = 0.0;  // m, standard deviation of the height of its centre; 0 if unknown
  double width = 0.0;         // m, mean of the two horizontal ones

  double Height() const { return top - bottom; }
};

// The rotation into the upright frame. The x axis is near the one of the world.
Eigen::Quaterniond UprightFromWorld(const Eigen::Vector3d& up);

// The body of an object with the given observations. The silhouettes measure how far the object
// reaches beyond its ellipsoid in each direction (misfit.h), so the body of a box is less
// round than its ellipsoid. In directions that no observation has measured, it is the ellipsoid.
ObjectBody MeasureBody(ObjectId id, const Ellipsoid& ellipsoid, const PinholeCamera& camera,
                       std::span<const ResolvedObservation> observations,
                       const Eigen::Quaterniond& upright_from_world);

// The same for an object that is known by its ellipsoid alone.
ObjectBody BodyOfEllipsoid(ObjectId id, const Ellipsoid& ellipsoid,
                           const Eigen::Quaterniond& upright_from_world);

// The upright box of the smallest footprint, in the world.
UprightBox BoxOf(const ObjectBody& body, const Eigen::Quaterniond& upright_from_world);

// The distance between two footprints, m. If they overlap, it is negative: the least distance by
// which one of them must be moved.
double FootprintGap(const ObjectBody& a, const ObjectBody& b);

// The common part of the two footprints, as a share of the smaller one.
double FootprintOverlap(const ObjectBody& a, const ObjectBody& b);

// The distance between the surfaces of two ellipsoids, m. Negative as FootprintGap() is.
double EllipsoidGap(const Ellipsoid& a, const Ellipsoid& b);

// The share of the volume of `a` that is inside `b`.
double VolumeShare(const Ellipsoid& a, const Ellipsoid& b);

}  // namespace hullslam
