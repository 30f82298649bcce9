// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "objects/resolved_observation.h"

namespace hullslam {

// The input of a start method. The references must outlive this struct.
struct StartInput {
  const PinholeCamera& camera;
  std::span<const ResolvedObservation>
      observations;        // with their surface landmarks (AddSurfaceLandmarks)
  Eigen::Vector3d center;  // about where the object is, world
  bool has_depth = false;  // HasDepth(observations)
  const StartOptions& options;
};

// The quadrics from which refinement may begin. Empty if the observations do not give any.
using StartMethod = std::vector<Ellipsoid>(const StartInput& input);

// Each method has its own file, and a row in the table of start_method.cc.
StartMethod& MethodOf(ObjectStart start);

// The names in settings files, in the order of the enumerators: fitted, oriented_box, box_planes,
// ray_sphere, single_view.
std::vector<std::string> ObjectStartNames();

// `fitted` (ours): two boxes of the depth points or, without depth, spheres by landmarks and rays
// (initialisation.h).
std::vector<Ellipsoid> StartFitted(const StartInput& input);

// `ray_sphere` (OA-SLAM): StartFromRays(), with depth too.
std::vector<Ellipsoid> StartByRays(const StartInput& input);

// The ellipsoid of a dual quadric of any scale: with its last element scaled to -1 it is
// [[M - t t^T, -t], [-t^T, -1]] with the centre t and M = R diag(s^2) R^T. If M is not positive,
// the quadric is no ellipsoid; then the absolute values of its eigenvalues are taken, as
// QuadricSLAM does. Nothing if the centre is infinitely far away or a half axis is zero.
std::optional<Ellipsoid> EllipsoidOfDualQuadric(const Eigen::Matrix4d& quadric);

// `box_planes` (Nicholson et al. 2019, section III.E; QISO-SLAM): each side of the bounding boxes
// is the image of a plane pi that touches the quadric, pi^T Q* pi = 0. With three observations or
// more these are linear equations for the ten numbers of Q*, whose least-squares solution is the
// singular vector of the least singular value. Observations whose box the border of the image cuts
// are left out if three others remain. The equations are solved about `center` and in units of the
// distance, which does not change their exact solution. Empty if the ellipsoid is not in front of
// all cameras.
std::vector<Ellipsoid> StartByBoxPlanes(const StartInput& input);

// `oriented_box` (Song et al. 2022, Yu et al. 2025): the ellipsoid in the oriented bounding box of
// the points inside the masks. These are depth points or, without depth, landmarks. The share
// `trimmed` is left out at each end of each axis, and the half axes take the inflation.
std::vector<Ellipsoid> StartByOrientedBox(const StartInput& input);

// `single_view` (VOOM, Wang et al. 2024, and the constructor of the released Object.cc): the first
// view with depth gives an ellipsoid that faces its camera. Its centre is at the median depth of
// the mask in the middle of the bounding box, its width and height are those of the box there, and
// its thickness is the extent of the depths in the mask (their 5 % to 95 % quantile), bounded to
// 0.05 and 0.2 m. Without depth, StartByRays().
std::vector<Ellipsoid> StartBySingleView(const StartInput& input);

}  // namespace hullslam
