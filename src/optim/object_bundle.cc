// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/object_bundle.h"

#include <algorithm>
#include <utility>

#include "objects/constraint/object_constraint.h"
#include "util/lists.h"

namespace hullslam::internal {
namespace {

// Whether the result is finite and no half axis has changed by more than the factor `max_change`.
bool IsPlausible(const Ellipsoid& after, const Ellipsoid& before, double max_change) {
  const Eigen::Array3d ratio = after.half_axes.array() / before.half_axes.array();
  return after.world_from_object.ToMatrix().allFinite() && (ratio > 1.0 / max_change).all() &&
         (ratio < max_change).all();
}

// Whether the cost is defined at the start. Otherwise the solver would fail.
bool IsDefined(const ceres::CostFunction& cost, const PoseBlock& camera, const PoseBlock& object,
               const Eigen::Vector3d& log_axes) {
  const double* parameters[] = {camera.data(), object.data(), log_axes.data()};
  Eigen::VectorXd residuals(cost.num_residuals());
  return cost.Evaluate(parameters, residuals.data(), nullptr) && residuals.allFinite();
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
    : camera_(camera), options_(options), moving_poses_(window.moving.size()) {
  for (const ObjectId id : window.objects) {
    AddObject(map, id, pose_indices);
  }
}

void ObjectBundle::AddObject(const Map& map, ObjectId id, const PoseIndices& pose_indices) {
  const ObjectLandmark& landmark = map.objects().At(id);
  Object& object = objects_.emplace_back();
  object.id = id;
  object.is_fixed = landmark.IsFixed();
  object.before = landmark.ellipsoid;
  object.pose = ToBlock(landmark.ellipsoid.world_from_object);
  object.log_axes = landmark.ellipsoid.half_axes.array().log();
  object.fixed_part = std::make_unique<ObjectSumCost>(ObjectSumCost::Camera::kNone);
  std::vector<ObjectObservation> outer;
  for (const ObjectObservation& seen : landmark.observations) {
    if (const size_t* const pose = pose_indices.Find(seen.keyframe)) {
      AddView(map, seen, landmark.misfit_px, *pose < moving_poses_ ? pose : nullptr);
    } else {
      outer.push_back(seen);
    }
  }
  for (const ObjectObservation& seen : Thin(outer, static_cast<size_t>(options_.max_outer_views))) {
    AddView(map, seen, landmark.misfit_px, nullptr);
  }
  object.fixed_part->Add(
      MakeObjectPrior(landmark.ellipsoid, object.has_depth, options_.constraint));
}

void ObjectBundle::AddView(const Map& map, const ObjectObservation& seen, double misfit_px,
                           const size_t* pose) {
  const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
  const Detection& detection = keyframe.frame->detections[seen.detection];
  const ResolvedObservation observation{seen.keyframe, keyframe.cam_from_world, &detection};
  const PoseBlock camera = ToBlock(keyframe.cam_from_world);
  Object& object = objects_.back();
  object.has_depth |= !detection.points.empty();
  ObjectConstraint constraint =
      MakeObjectConstraint(camera_, observation, detection.lines, object.before, misfit_px,
                           options_.constraint, detection.right_lines);
  auto moving_part = std::make_unique<ObjectSumCost>(ObjectSumCost::Camera::kMoving);
  for (auto* const cost : {&constraint.silhouette, &constraint.depth}) {
    if (*cost == nullptr || !IsDefined(**cost, camera, object.pose, object.log_axes)) {
      continue;
    }
    if (pose != nullptr) {
      moving_part->Add(std::move(*cost));
    } else {
      object.fixed_part->Add(std::move(*cost), camera);
    }
  }
  if (moving_part->size() > 0) {
    observations_.push_back({objects_.size() - 1, *pose, std::move(moving_part)});
  }
}

size_t ObjectBundle::CountCosts() const {
  size_t count = 0;
  for (const Object& object : objects_) {
    count += object.fixed_part->size();
  }
  for (const Observation& observation : observations_) {
    count += observation.cost->size();
  }
  return count;
}

void ObjectBundle::AddResiduals(ceres::Problem& problem, std::vector<PoseBlock>& poses) {
  for (Object& object : objects_) {
    problem.AddResidualBlock(object.fixed_part.get(), nullptr, object.pose.data(),
                             object.log_axes.data());
  }
  for (Observation& observation : observations_) {
    Object& object = objects_[observation.object];
    problem.AddResidualBlock(observation.cost.get(), nullptr, poses[observation.pose].data(),
                             object.pose.data(), object.log_axes.data());
  }
}

void ObjectBundle::AddParameters(ceres::Problem& problem, PoseManifold& manifold,
                                 ceres::ParameterBlockOrdering& ordering) {
  // Ceres sorts the blocks of a group by address. Each group has the blocks of one vector only, so
  // they stay in the order of the vector. With blocks of two vectors the order would depend on
  // where these are in memory, and results would differ from run to run.
  for (Object& object : objects_) {
    if (object.is_fixed) {
      problem.SetParameterBlockConstant(object.pose.data());
      problem.SetParameterBlockConstant(object.log_axes.data());
    }
    problem.SetManifold(object.pose.data(), &manifold);
    ordering.AddElementToGroup(object.pose.data(), 2);
    ordering.AddElementToGroup(object.log_axes.data(), 0);
  }
}

bool ObjectBundle::HasMoving() const { return !std::ranges::all_of(objects_, &Object::is_fixed); }

bool ObjectBundle::HasUndefinedObservation() const {
  return std::any_of(objects_.begin(), objects_.end(),
                     [](const Object& object) { return object.fixed_part->HasUndefined(); }) ||
         std::any_of(
             observations_.begin(), observations_.end(),
             [](const Observation& observation) { return observation.cost->HasUndefined(); });
}

bool ObjectBundle::LeaveOutUndefinedObservations() {
  const bool has_undefined = HasUndefinedObservation();
  for (Object& object : objects_) {
    object.fixed_part->LeaveOutUndefined();
  }
  for (Observation& observation : observations_) {
    observation.cost->LeaveOutUndefined();
  }
  return has_undefined;
}

bool ObjectBundle::IsDefinedEverywhere(size_t index, const std::vector<PoseBlock>& poses) const {
  const Object& object = objects_[index];
  const double* parameters[] = {nullptr, object.pose.data(), object.log_axes.data()};
  return object.fixed_part->AreLeftOutDefined(parameters + 1) &&
         std::all_of(observations_.begin(), observations_.end(),
                     [&](const Observation& observation) {
                       parameters[0] = poses[observation.pose].data();
                       return observation.object != index ||
                              observation.cost->AreLeftOutDefined(parameters);
                     });
}

void ObjectBundle::Write(const std::vector<PoseBlock>& poses, BundleResult& result) const {
  for (size_t i = 0; i < objects_.size(); ++i) {
    const Object& object = objects_[i];
    Ellipsoid after{FromBlock(object.pose.data()), object.log_axes.array().exp()};
    after.world_from_object.rotation.normalize();
    if (object.is_fixed) {
      continue;
    }
    if (IsPlausible(after, object.before, options_.max_axis_change) &&
        IsDefinedEverywhere(i, poses)) {
      result.ellipsoids.emplace_back(object.id, after);
    } else {
      result.failed_objects.push_back(object.id);
    }
  }
}

}  // namespace hullslam::internal
