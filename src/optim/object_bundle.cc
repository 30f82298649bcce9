// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/object_bundle.h"

#include <algorithm>
#include <utility>

#include "objects/object_constraint.h"
#include "util/thin.h"

namespace hullslam::internal {
namespace {

// Whether the result is finite and no half axis has changed by more than the factor `max_change`.
bool IsPlausible(const Ellipsoid& after, const Ellipsoid& before, double max_change) {
  const Eigen::Array3d ratio = after.half_axes.array() / before.half_axes.array();
  return after.world_from_object.ToMatrix().allFinite() && (ratio > 1.0 / max_change).all() &&
         (ratio < max_change).all();
}

}  // namespace

PoseIndices IndexPoses(const BundleWindow& window) {
  PoseIndices indices;
  for (const auto* ids : {&window.moving, &window.fixed}) {
    for (const KeyframeId id : *ids) {
      const size_t index = indices.entries().size();
      indices[id] = index;
    }
  }
  return indices;
}

ObjectBundle::ObjectBundle(const Map& map, const PinholeCamera& camera, const BundleWindow& window,
                           const PoseIndices& pose_indices, const ObjectBundleOptions& options)
    : camera_(camera), options_(options), window_poses_(pose_indices.entries().size()) {
  for (const ObjectId id : window.objects) {
    AddObject(map, id, pose_indices);
  }
}

void ObjectBundle::AddObject(const Map& map, ObjectId id, const PoseIndices& pose_indices) {
  const ObjectLandmark& landmark = map.objects().At(id);
  Object& object = objects_.emplace_back();
  object.id = id;
  object.before = landmark.ellipsoid;
  object.pose = ToBlock(landmark.ellipsoid.world_from_object);
  object.log_axes = landmark.ellipsoid.half_axes.array().log();
  std::vector<ObjectObservation> outer;
  for (const ObjectObservation& seen : landmark.observations) {
    if (const size_t* const pose = pose_indices.Find(seen.keyframe)) {
      AddView(map, seen, landmark.misfit_px, *pose);
    } else {
      outer.push_back(seen);
    }
  }
  for (const ObjectObservation& seen : Thin(outer, static_cast<size_t>(options_.max_outer_views))) {
    outer_poses_.push_back(ToBlock(map.keyframes().At(seen.keyframe).cam_from_world));
    AddView(map, seen, landmark.misfit_px, window_poses_ + outer_poses_.size() - 1);
  }
  object.prior = MakeObjectPrior(landmark.ellipsoid, object.has_depth, options_.constraint);
}

void ObjectBundle::AddView(const Map& map, const ObjectObservation& seen, double misfit_px,
                           size_t pose) {
  const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
  const Detection& detection = keyframe.frame->detections[seen.detection];
  const ObjectView view{seen.keyframe, keyframe.cam_from_world, &detection};
  Object& object = objects_.back();
  ObjectConstraint constraint = MakeObjectConstraint(camera_, view, detection.lines, object.before,
                                                     misfit_px, options_.constraint);
  AddTerm(keyframe.cam_from_world, pose, std::move(constraint.outline));
  AddTerm(keyframe.cam_from_world, pose, std::move(constraint.depth));
  object.has_depth |= !detection.points.empty();
}

// Adds the term, unless it is null or not defined at the start: there the solver would fail.
void ObjectBundle::AddTerm(const Rigid3& cam_from_world, size_t pose,
                           std::unique_ptr<ceres::CostFunction> cost) {
  if (cost == nullptr) {
    return;
  }
  const PoseBlock camera = ToBlock(cam_from_world);
  const Object& object = objects_.back();
  const double* parameters[] = {camera.data(), object.pose.data(), object.log_axes.data()};
  Eigen::VectorXd residuals(cost->num_residuals());
  if (cost->Evaluate(parameters, residuals.data(), nullptr) && residuals.allFinite()) {
    terms_.push_back({objects_.size() - 1, pose, std::move(cost)});
  }
}

void ObjectBundle::AddResiduals(ceres::Problem& problem, std::vector<PoseBlock>& poses) {
  for (Object& object : objects_) {
    problem.AddResidualBlock(object.prior.get(), nullptr, object.pose.data(),
                             object.log_axes.data());
  }
  for (Term& term : terms_) {
    PoseBlock& pose =
        term.pose < window_poses_ ? poses[term.pose] : outer_poses_[term.pose - window_poses_];
    Object& object = objects_[term.object];
    problem.AddResidualBlock(term.cost.get(), nullptr, pose.data(), object.pose.data(),
                             object.log_axes.data());
  }
}

void ObjectBundle::AddParameters(ceres::Problem& problem, PoseManifold& manifold, int axes_group,
                                 ceres::ParameterBlockOrdering& ordering) {
  // Ceres sorts the blocks of a group by address. Each group has the blocks of one vector only, so
  // they stay in the order of the vector. With blocks of two vectors the order would depend on
  // where these are in memory, and results would differ from run to run.
  for (Object& object : objects_) {
    problem.SetManifold(object.pose.data(), &manifold);
    ordering.AddElementToGroup(object.pose.data(), 2);
    ordering.AddElementToGroup(object.log_axes.data(), axes_group);
  }
  for (PoseBlock& pose : outer_poses_) {
    if (problem.HasParameterBlock(pose.data())) {
      problem.SetParameterBlockConstant(pose.data());
      ordering.AddElementToGroup(pose.data(), 3);
    }
  }
}

void ObjectBundle::Write(BundleResult& result) const {
  for (const Object& object : objects_) {
    Ellipsoid after{FromBlock(object.pose.data()), object.log_axes.array().exp()};
    after.world_from_object.rotation.normalize();
    if (IsPlausible(after, object.before, options_.max_axis_change)) {
      result.ellipsoids.emplace_back(object.id, after);
    } else {
      result.failed_objects.push_back(object.id);
    }
  }
}

}  // namespace hullslam::internal
