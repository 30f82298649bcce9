// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/object_bundle.h"

#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "costs/depth_anchor.h"
#include "costs/make_object_cost.h"
#include "costs/object_measurement.h"
#include "costs/pixel_error.h"
#include "costs/robust_rows.h"

namespace hullslam::internal {
namespace {

constexpr double kMinTukeyPx = 15.0;    // a loss that lets go earlier spoils the shape
constexpr double kSystematic = 2.0;     // what an ellipsoid misses it misses in all similar views
constexpr double kMaxAxisChange = 3.0;  // more is no adjustment of the quadric that was there

// Half axes may only be so different from before.
bool IsPlausible(const Ellipsoid& after, const Ellipsoid& before) {
  const Eigen::Array3d ratio = after.half_axes.array() / before.half_axes.array();
  return after.world_from_object.ToMatrix().allFinite() && (ratio > 1.0 / kMaxAxisChange).all() &&
         (ratio < kMaxAxisChange).all();
}

// At most `count` of the elements, evenly chosen.
template <typename T>
std::vector<T> Thin(const std::vector<T>& all, size_t count) {
  std::vector<T> thinned;
  count = std::min(count, all.size());
  thinned.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    thinned.push_back(all[i * all.size() / count]);
  }
  return thinned;
}

std::unique_ptr<ceres::CostFunction> Weigh(std::unique_ptr<ceres::CostFunction> cost,
                                           std::unique_ptr<ceres::LossFunction> loss,
                                           double max_effective_rows) {
  const double weight = std::min(1.0, max_effective_rows / cost->num_residuals());
  return std::make_unique<RobustRowsCost>(std::move(cost), std::move(loss), weight);
}

}  // namespace

ObjectBundle::ObjectBundle(const Map& map, const PinholeCamera& camera, const BundleWindow& window,
                           const ObjectBundleOptions& options)
    : camera_(camera), options_(options) {
  std::vector<KeyframeId> keyframes = window.moving;
  keyframes.insert(keyframes.end(), window.fixed.begin(), window.fixed.end());
  window_poses_ = keyframes.size();
  for (const ObjectId id : window.objects) {
    AddObject(map, id, keyframes);
  }
}

void ObjectBundle::AddObject(const Map& map, ObjectId id,
                             const std::vector<KeyframeId>& keyframes) {
  const ObjectLandmark& landmark = map.objects().At(id);
  Object& object = objects_.emplace_back();
  object.id = id;
  object.before = landmark.ellipsoid;
  object.pose = ToBlock(landmark.ellipsoid.world_from_object);
  object.log_axes = landmark.ellipsoid.half_axes.array().log();
  std::vector<ObjectObservation> outer;
  for (const ObjectObservation& seen : landmark.observations) {
    const auto place = std::find(keyframes.begin(), keyframes.end(), seen.keyframe);
    if (place == keyframes.end()) {
      outer.push_back(seen);
      continue;
    }
    const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
    AddView(keyframe, keyframe.frame->detections[seen.detection], landmark.misfit_px,
            static_cast<size_t>(place - keyframes.begin()));
  }
  for (const ObjectObservation& seen : Thin(outer, options_.max_outer_views)) {
    const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
    outer_poses_.push_back(ToBlock(keyframe.cam_from_world));
    AddView(keyframe, keyframe.frame->detections[seen.detection], landmark.misfit_px,
            window_poses_ + outer_poses_.size() - 1);
  }
  object.prior = std::make_unique<QuadricPriorCost>(
      landmark.ellipsoid, object.has_depth ? options_.prior : options_.prior_blind);
}

void ObjectBundle::AddView(const Keyframe& keyframe, const Detection& detection, double misfit_px,
                           size_t pose) {
  AddTerm(keyframe.cam_from_world, pose, MakeOutline(keyframe, detection, misfit_px));
  AddTerm(keyframe.cam_from_world, pose, MakeDepth(detection));
  objects_.back().has_depth |= !detection.points.empty();
}

std::unique_ptr<ceres::CostFunction> ObjectBundle::MakeOutline(const Keyframe& keyframe,
                                                               const Detection& detection,
                                                               double misfit_px) const {
  const double sigma_px = std::hypot(options_.sigma_px, kSystematic * misfit_px);
  const auto sigma = ResidualOfPixelError(options_.residual, camera_, keyframe.cam_from_world,
                                          objects_.back().before, sigma_px);
  if (!sigma.has_value()) {
    return nullptr;
  }
  auto cost = MakeObjectCost(options_.residual, options_.primitive, camera_,
                             ToMeasurement(detection), *sigma);
  if (cost == nullptr) {
    return nullptr;
  }
  const double tukey = std::max(options_.tukey, kMinTukeyPx / sigma_px);
  return Weigh(std::move(cost), std::make_unique<ceres::TukeyLoss>(tukey),
               options_.max_effective_lines);
}

std::unique_ptr<ceres::CostFunction> ObjectBundle::MakeDepth(const Detection& detection) const {
  const std::vector<Eigen::Vector3d> points = Thin(detection.points, options_.max_depth_points);
  if (points.empty()) {
    return nullptr;
  }
  return Weigh(std::make_unique<DepthAnchorCost>(points, options_.depth_sigma),
               std::make_unique<ceres::CauchyLoss>(options_.cauchy), options_.max_effective_points);
}

// Passes over a term that is null or not defined at the start, where the solver would fail.
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

void ObjectBundle::AddParameters(ceres::Problem& problem, PoseManifold& manifold,
                                 ceres::ParameterBlockOrdering& ordering) {
  // Ceres sorts a group by address. A group holds the blocks of one vector only, so that their
  // order is that of the vector, not of where two vectors happen to lie: else no two runs are
  // alike.
  for (Object& object : objects_) {
    problem.SetManifold(object.pose.data(), &manifold);
    ordering.AddElementToGroup(object.pose.data(), 2);
    ordering.AddElementToGroup(object.log_axes.data(), 2);
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
    if (IsPlausible(after, object.before)) {
      result.ellipsoids.emplace_back(object.id, after);
    } else {
      result.failed_objects.push_back(object.id);
    }
  }
}

}  // namespace hullslam::internal
