// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>

#include "costs/robust_rows.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/line2.h"
#include "hullslam/objects/object_constraint_options.h"
#include "hullslam/objects/object_view.h"

namespace hullslam {

// The constraint of one detection on an object and on the pose it is seen from, as costs over the
// parameters of QuadricInCamera (pose of the camera, pose of the object, log half axes).
struct ObjectConstraint {
  std::unique_ptr<RobustRowsCost> outline;  // null where MakeObjectCost is, or not in front
  std::unique_ptr<RobustRowsCost> depth;    // null without depth points
};

// Refinement, joint pose and bundle adjustment all constrain objects by this. With n rows of the
// residual the outline adds
//   min(1, max_effective_lines / n) sum over the rows r of rho(r / sigma)
// where sigma = ResidualOfPixelError(hypot(sigma_px, misfit_factor * misfit_px)) at the view's pose
// and `ellipsoid`, and rho is the loss at max(loss_scale, min_loss_px / that hypot) sigmas. Depth
// points add the same with DepthAnchorCost. `lines` are those of the view's detection, or these
// moved.
ObjectConstraint MakeObjectConstraint(const PinholeCamera& camera, const ObjectView& view,
                                      std::span<const SilhouetteLine> lines,
                                      const Ellipsoid& ellipsoid, double misfit_px,
                                      const ObjectConstraintOptions& options);

// The prior of an object about a shape (QuadricPriorCost), over the object's pose and log half
// axes.
std::unique_ptr<ceres::CostFunction> MakeObjectPrior(const Ellipsoid& shape, bool has_depth,
                                                     const ObjectConstraintOptions& options);

// Whether lines are what the residual takes of a detection.
bool TakesLines(ObjectResidual residual);

}  // namespace hullslam
