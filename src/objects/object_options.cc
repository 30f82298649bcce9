// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_options.h"

#include <string>

#include "hullslam/objects/object_constraint_options.h"
#include "hullslam/util/error.h"
#include "objects/comparison/association_measure.h"
#include "objects/start_method.h"

namespace hullslam {
namespace {

// The keys that refinement, joint pose estimation and bundle adjustment have.
void BindOutline(const OptionScope& use, Range lines, ObjectConstraintOptions& constraint) {
  use.AddEnum("residual", &constraint.residual, ObjectResidualNames(),
              "residual that is minimised between a quadric and a detection");
  use.AddEnum("loss", &constraint.loss, RobustLossNames(), "robust loss of each residual");
  use.Add("max_effective_lines", &constraint.max_effective_lines, lines,
          "largest number of effective lines per detection");
}

// The keys that joint pose estimation and bundle adjustment have.
void BindSigma(const OptionScope& use, ObjectConstraintOptions& constraint) {
  use.Add("sigma", &constraint.sigma_px, Range::Between(0.001, 1000.0),
          "standard deviation of a line, in addition to the misfit of the object, px");
  use.AddEnum("sigma_unit", &constraint.sigma_unit, SigmaUnitNames(),
              "unit of sigma: pixels, which are converted for the size and distance of each "
              "object, or that of the residual, which has no misfit");
  use.Add("misfit_factor", &constraint.misfit_factor, Range::Between(0.0, 100.0),
          "factor of the misfit of the object in the standard deviation of a line");
  use.Add("loss_scale", &constraint.loss_scale, Range::Between(0.1, 1000.0),
          "scale of the robust loss, in standard deviations");
}

// The key of the uses that change quadrics.
void BindDepthPoints(const OptionScope& use, ObjectConstraintOptions& constraint) {
  use.Add("depth_points", &constraint.depth.max_points, Range::Between(0, 10000),
          "largest number of depth points that are used per detection; 0: none");
}

void CheckResidual(const std::string& use, ObjectResidual residual, ObjectPrimitive primitive) {
  if (!AcceptsPrimitive(residual, primitive)) {
    throw InputError("settings: objects." + use + ".residual '" + std::string(NameOf(residual)) +
                     "' cannot be computed from objects.detection.primitive '" +
                     std::string(NameOf(primitive)) + "'");
  }
}

}  // namespace

void AssociationOptions::Bind(const OptionScope& scope) {
  scope.AddEnum("measure", &measure, AssociationMeasureNames(),
                "how detections and objects are compared (docs/objects.md)");
}

void StartOptions::Bind(const OptionScope& scope) {
  scope.AddEnum("method", &method, ObjectStartNames(),
                "how the first quadric of an object is made (docs/objects.md)");
  scope.Add("min_views", &min_views, Range::Between(1, 1000),
            "number of keyframes that must observe an object before it is mapped");
  scope.Add("min_parallax", &min_parallax, Range::Between(0.0, 180.0),
            "least angle between rays that an object with depth needs to be mapped, degrees");
  scope.Add("min_parallax_without_depth", &min_parallax_without_depth, Range::Between(0.0, 180.0),
            "least angle between rays that an object without depth needs to be mapped, degrees");
  scope.Add("inflation", &inflation, Range::Between(0.5, 3.0),
            "half axes of the start of a quadric in relation to those of the box of its points");
}

void ValidityOptions::Bind(const OptionScope& scope) {
  scope.Add("min_overlap", &min_overlap, Range::Share(),
            "least mean IoU of projected ellipse and hull for a mapped object");
  scope.Add("min_points_near", &min_points_near, Range::Share(),
            "least share of depth points inside or near a mapped object");
  scope.Add("max_stretch", &max_stretch, Range::Between(1.0, 1000.0),
            "largest ratio of a half axis of a mapped object to the extent of its depth points "
            "along it");
  scope.Add("max_misfit", &max_misfit, Range::Between(0.0, 100.0),
            "largest RMS distance of the outlines of a mapped object from its projected ellipses, "
            "as a share of the size of its masks");
  scope.Add(
      "max_elongation", &max_elongation, Range::Between(1.0, 1000.0),
      "a mapped object that is longer along its rays than across them by a larger factor needs "
      "more parallax");
}

void FusionOptions::Bind(const OptionScope& scope) {
  scope.Add("min_overlap", &min_overlap, Range::Share(),
            "two objects that were never seen together are fused if the IoU of their volumes is at "
            "least this");
}

void CullingOptions::Bind(const OptionScope& scope) {
  scope.Add("min_found_ratio", &min_found_ratio, Range::Share(),
            "a mapped object is removed if it is found in a smaller share of the keyframes that "
            "should show it");
  scope.Add("max_range", &max_range, Range::Between(0.0, 1000.0),
            "a keyframe should show an object only up to this many times the largest distance at "
            "which the object was observed");
  scope.Add("max_hidden", &max_hidden, Range::Share(),
            "a keyframe should show an object only if at most this share of it is hidden");
}

void ChangeOptions::Bind(const OptionScope& scope) {
  scope.Add("min_keyframes", &min_keyframes, Range::Between(1, 1000000),
            "keyframes that should show an object before it is called gone or new");
  scope.Add("max_found_ratio", &max_found_ratio, Range::Share(),
            "an object is gone or new if it is found in a smaller share of the keyframes that "
            "should show it");
  scope.Add("max_move", &max_move, Range::Between(0.0, 1e6),
            "an object is taken for one that was moved only up to this distance, m");
}

void ObjectRefinementOptions::Bind(const OptionScope& scope) {
  BindOutline(scope, Range::Between(0.1, 1000.0), constraint);
  BindDepthPoints(scope, constraint);
  scope.Add("max_views", &max_views, Range::Between(2, 10000),
            "largest number of keyframes that are used to refine a quadric");
  scope.Add("min_misfit_px", &min_misfit_px, Range::Between(0.1, 100.0),
            "least standard deviation of a line when a quadric is refined, px");
  scope.Add("max_misfit_px", &max_misfit_px, Range::Between(0.1, 100.0),
            "largest standard deviation of a line when a quadric is refined, px");
}

void ObjectPoseOptions::Bind(const OptionScope& scope) {
  BindOutline(scope, Range::Between(0.0, 1000.0), constraint);
  BindSigma(scope, constraint);
}

void ObjectBundleOptions::Bind(const OptionScope& scope) {
  BindOutline(scope, Range::Between(0.0, 1000.0), constraint);
  BindSigma(scope, constraint);
  BindDepthPoints(scope, constraint);
  scope.Add("min_loss_px", &constraint.min_loss_px, Range::Between(0.0, 1000.0),
            "least scale of the robust loss, px");
  scope.Add("max_outer_views", &max_outer_views, Range::Between(0, 10000),
            "largest number of keyframes outside the window that constrain an object");
}

// The keys of several uses.
void ObjectOptions::BindShared(const OptionScope& scope) {
  scope.AddShared("residual", {"refinement.residual", "pose.residual", "bundle.residual"},
                  "residual that is minimised between a quadric and a detection");
  scope.AddShared("sigma", {"pose.sigma", "bundle.sigma"},
                  "standard deviation of a line in joint pose and bundle adjustment, in addition "
                  "to the misfit of the object, px");
  scope.AddShared("max_effective_lines", {"pose.max_effective_lines", "bundle.max_effective_lines"},
                  "largest number of effective lines per detection, in joint pose and bundle "
                  "adjustment");
  ObjectConstraintOptions& refined = refinement.constraint;
  ObjectConstraintOptions& adjusted = bundle.constraint;
  scope.Add("depth_sigma", {&refined.depth.sigma, &adjusted.depth.sigma},
            Range::Between(0.001, 100.0),
            "standard deviation of the distance of depth points from the surface of a quadric, m");
  scope.Add("prior_sigma", {&refined.prior.log_axes, &adjusted.prior.log_axes},
            Range::Between(0.01, 100.0),
            "standard deviation of the log half axes in the prior about a quadric");
  scope.Add("prior_sigma_without_depth",
            {&refined.prior_without_depth.log_axes, &adjusted.prior_without_depth.log_axes},
            Range::Between(0.01, 100.0),
            "standard deviation of the log half axes in the prior about a quadric, for an object "
            "without depth");
}

void ObjectOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "objects");
  scope.Add("enabled", &enabled, "map objects from their masks");
  scope.Add("joint_pose", &joint_pose, "mapped objects constrain the pose of each frame");
  scope.Add("bundle_adjustment", &bundle_adjustment,
            "adjust quadrics together with poses and landmarks");
  scope.Add("misfit_compensation", &misfit_compensation,
            "correct lines by the excess that other keyframes measured");
  scope.Add("guided_matching", &guided_matching,
            "search landmarks on mapped objects that are not in the local map, inside the hulls of "
            "their detections");
  scope.Add(
      "sizes", &sizes, Range::Between(0.001, 20.0),
      "longest side of objects by class, m; a monocular run gets its scale from objects of known "
      "size");
  detection.Bind(scope.Inner("detection"));
  association.Bind(scope.Inner("association"));
  start.Bind(scope.Inner("start"));
  validity.Bind(scope.Inner("validity"));
  fusion.Bind(scope.Inner("fusion"));
  culling.Bind(scope.Inner("culling"));
  changes.Bind(scope.Inner("changes"));
  refinement.Bind(scope.Inner("refinement"));
  pose.Bind(scope.Inner("pose"));
  bundle.Bind(scope.Inner("bundle"));
  BindShared(scope);
}

void ObjectOptions::Validate() const {
  CheckResidual("refinement", refinement.constraint.residual, detection.primitive);
  CheckResidual("pose", pose.constraint.residual, detection.primitive);
  CheckResidual("bundle", bundle.constraint.residual, detection.primitive);
}

std::vector<std::string> RobustLossNames() { return {"none", "huber", "cauchy", "tukey"}; }

std::vector<std::string> SigmaUnitNames() { return {"pixels", "residual"}; }

}  // namespace hullslam
