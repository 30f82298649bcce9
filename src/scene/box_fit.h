// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "objects/resolved_observation.h"
#include "scene/scene.h"

namespace hullslam {

// A plane that touches an object: n . x is at most `support` for all its points x.
struct SupportPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // unit vector, outwards
  double support = 0.0;                               // m
  double pixels_per_metre = 1.0;  // shift of the line in its image per shift of the plane
  size_t view = 0;                // index of the observation
};

// The planes of all lines of the observations that nothing cuts off, in the frame of
// `frame_from_world`. Their distances from the camera are those of the ellipsoid.
std::vector<SupportPlane> SupportPlanesOf(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                                          std::span<const ResolvedObservation> observations,
                                          const Eigen::Quaterniond& frame_from_world);

// The box with the z axis upwards that touches the planes of the silhouettes best, in the frame of
// the planes, whose z axis points upwards. The support of a box with the centre c, the axes a_i and
// the half extents h_i is linear in c and h:
//   max n . x = n . c + sum_i |n . a_i| h_i.
// So for each rotation about z, c and h follow from linear least squares of the distances in the
// images, with Cauchy's loss, and the best rotation is searched (`world_from_box` is in the frame).
// What few planes tell is near `ellipsoid` (in the same frame), whose box is the prior. Nothing if
// the planes fit the ellipsoid nearly as well as the best box, so that the object may be round, or
// if they are too few.
//
// In the last step a plane that cuts the box has an eighth of the weight of one beyond it, because
// a thing such as a chair is smaller than its box in most directions.
std::optional<UprightBox> FitBox(std::span<const SupportPlane> planes, const Ellipsoid& ellipsoid);

// Which sides of a box in the world the planes in the frame of `frame_from_world` limit. A side is
// seen if planes of two views or more touch it: a plane touches the side whose place changes its
// support most, which is the side whose outward normal is nearest to its own. (So a plane whose
// normal is up to 30 degrees from that of a side always touches it.) The place of a side has no
// sigma: neither the information of the lines nor a jackknife over the views came near the true
// errors, because most of them come from the shape (docs/scene.md).
void FindSeenSides(std::span<const SupportPlane> planes, const Eigen::Quaterniond& frame_from_world,
                   UprightBox& box);

}  // namespace hullslam
