// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
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

}  // namespace hullslam
