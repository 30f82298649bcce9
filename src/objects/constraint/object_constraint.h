// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>

#include "costs/wrapped_costs.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/line2.h"
#include "hullslam/objects/object_constraint_options.h"
#include "objects/resolved_observation.h"

namespace hullslam {

// The constraint of one detection on an object and on the pose of the camera. The parameters of the
// costs are those of QuadricInCamera (pose of the camera, pose of the object, log half axes).
struct ObjectConstraint {
  std::unique_ptr<RobustRowsCost>
      silhouette;  // null if MakeObjectCost gives null or the object is not in front
  std::unique_ptr<RobustRowsCost> depth;  // null without depth points
};

// Refinement, joint pose estimation and bundle adjustment all use this constraint. If the residual
// of the detection has n rows, it adds this to the cost:
//   min(1, max_effective_lines / n) sum over the rows r of rho(r / sigma)
// where sigma = ResidualOfPixelError(hypot(sigma_px, misfit_factor * misfit_px)) at the
// observation's pose and `ellipsoid`, and rho is the loss with the scale max(loss_scale,
// min_loss_px / that hypot), in sigmas. With SigmaUnit::kResidual, sigma = sigma_px instead. Depth
// points add the same kind of sum with DepthAnchorCost. `lines` are the lines of the observation's
// detection, possibly compensated. `right_lines`, those of the right image, are more rows of the
// same detection: their errors are those of its lines, so they do not make it count as more
// independent lines.
ObjectConstraint MakeObjectConstraint(const PinholeCamera& camera,
                                      const ResolvedObservation& observation,
                                      std::span<const SilhouetteLine> lines,
                                      const Ellipsoid& ellipsoid, double misfit_px,
                                      const ObjectConstraintOptions& options,
                                      std::span<const SilhouetteLine> right_lines = {});

// The prior that keeps an object near a shape (QuadricPriorCost). Its parameters are the object's
// pose and log half axes.
std::unique_ptr<ceres::CostFunction> MakeObjectPrior(const Ellipsoid& shape, bool has_depth,
                                                     const ObjectConstraintOptions& options);

}  // namespace hullslam
