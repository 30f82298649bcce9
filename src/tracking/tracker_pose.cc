// SPDX-License-Identifier: GPL-3.0-or-later
// How the tracker finds a pose: by the motion model, the reference keyframe, the local map.
#include <algorithm>
#include <utility>

#include "map/landmark_projection.h"
#include "matching/by_descriptor.h"
#include "matching/by_projection.h"
#include "optim/joint_pose_optimization.h"
#include "tracking/local_map.h"
#include "tracking/object_guide.h"
#include "tracking/tracker.h"

namespace hullslam {
namespace {

// Search windows in px at level 0 and bounds on matches: Mur-Artal and Tardos 2017.
constexpr double kMotionRadius = 15.0;
constexpr double kLocalRadius = 4.0;
constexpr double kLocalRadiusFrontal = 2.5;
constexpr double kCosFrontal = 0.998;
constexpr double kDepthRadiusFactor = 3.0;  // depth makes start poses and landmarks less sure

struct LevelRange {
  int min = 0;
  int max = 0;
};

// Moving forward patches grow, so that they are found at higher levels; backward at lower ones.
LevelRange LevelsAfterMotion(int level, double forward, double baseline, int level_count) {
  if (forward > baseline) {
    return {level, level_count - 1};
  }
  if (-forward > baseline) {
    return {0, level};
  }
  return {level - 1, level + 1};
}

// Where a landmark of the local map is searched; nothing where it cannot be recognised.
std::optional<Projection> ExpectLandmark(const Sensor& sensor, const Rigid3& cam_from_world,
                                         const Landmark& landmark) {
  const std::optional<LandmarkView> view = ViewLandmark(sensor, cam_from_world, landmark);
  if (!view) {
    return std::nullopt;
  }
  const double radius =
      kDepthRadiusFactor * (view->cos_view > kCosFrontal ? kLocalRadiusFrontal : kLocalRadius);
  Projection projection;
  projection.pixel = view->pixel.cast<float>();
  projection.right_u = static_cast<float>(view->right_u);
  projection.radius =
      static_cast<float>(radius) * sensor.levels.scale[static_cast<size_t>(view->level)];
  projection.min_level = view->level - 1;
  projection.max_level = view->level;
  projection.descriptor = landmark.descriptor;
  return projection;
}

}  // namespace

std::optional<Tracker::Estimate> Tracker::TrackWithMotionModel() const {
  if (!velocity_) {
    return std::nullopt;
  }
  Estimate estimate;
  estimate.cam_from_world = *velocity_ * last_from_world_;
  const double forward = Inverse(*velocity_).translation.z();
  std::vector<Projection> projections;
  std::vector<LandmarkId> ids;
  for (size_t i = 0; i < last_.landmarks.size(); ++i) {
    const Landmark* landmark = map_->landmarks().Find(last_.landmarks[i]);
    if (landmark == nullptr) {
      continue;
    }
    const Eigen::Vector3d point = estimate.cam_from_world * landmark->position;
    if (point.z() <= 0.0) {
      continue;
    }
    const Eigen::Vector2d pixel = sensor_.camera.Project(point);
    if (!sensor_.bounds.Contains(pixel)) {
      continue;
    }
    const Keypoint& seen = last_.frame->features.keypoints[i];
    const LevelRange levels =
        LevelsAfterMotion(seen.level, forward, sensor_.baseline(), sensor_.levels.count());
    Projection& projection = projections.emplace_back();
    projection.pixel = pixel.cast<float>();
    projection.right_u = static_cast<float>(pixel.x() - sensor_.camera.bf / point.z());
    projection.radius =
        static_cast<float>(kMotionRadius) * sensor_.levels.scale[static_cast<size_t>(seen.level)];
    projection.min_level = levels.min;
    projection.max_level = levels.max;
    projection.descriptor = landmark->descriptor;
    projection.angle = seen.angle;
    ids.push_back(last_.landmarks[i]);
  }
  const ProjectionSearch search{.max_distance = 100, .compare_rotation = true};
  std::vector<Match> matches = MatchByProjection(frame_->features, projections, {}, search);
  if (matches.size() < MinMotionMatches()) {
    for (Projection& projection : projections) {
      projection.radius *= 2.0f;
    }
    matches = MatchByProjection(frame_->features, projections, {}, search);
  }
  estimate.landmarks.resize(frame_->features.size());
  for (const Match& match : matches) {
    estimate.landmarks[match.keypoint] = ids[match.query];
  }
  // Objects are looked for here only where landmarks are too few without them.
  PoseObjects found;
  if (matches.size() < MinMotionMatches() && object_options_.joint_pose) {
    found = TakePoseObjects(estimate, FindObjects(estimate));
  }
  if (matches.size() + kObjectSupport * found.objects.size() < MinMotionMatches()) {
    return std::nullopt;
  }
  OptimizePose(estimate, found.objects);
  return Support(estimate) >= MinStartInliers() ? std::optional(std::move(estimate)) : std::nullopt;
}

int Tracker::Support(const Estimate& estimate) {
  return estimate.inliers + static_cast<int>(kObjectSupport) * estimate.objects;
}

std::optional<Tracker::Estimate> Tracker::TrackReferenceKeyframe() const {
  const Keyframe& reference = map_->keyframes().At(reference_);
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < reference.landmarks.size(); ++i) {
    if (reference.landmarks[i].IsValid()) {
      indices.push_back(i);
    }
  }
  const std::vector<Match> matches =
      MatchByDescriptor(reference.frame->features, indices, frame_->features, {});
  if (matches.size() < MinReferenceMatches()) {
    return std::nullopt;
  }
  Estimate estimate;
  estimate.cam_from_world = last_from_world_;
  estimate.landmarks.resize(frame_->features.size());
  for (const Match& match : matches) {
    estimate.landmarks[match.keypoint] = reference.landmarks[match.query];
  }
  OptimizePose(estimate);
  return estimate.inliers >= MinStartInliers() ? std::optional(std::move(estimate)) : std::nullopt;
}

std::optional<Tracker::Estimate> Tracker::TrackLocalMap(Estimate estimate) {
  const LocalMap local =
      SelectLocalMap(*map_, estimate.landmarks, static_cast<size_t>(options_.local_keyframes));
  if (local.reference.IsValid()) {
    reference_ = local.reference;
  }
  std::vector<bool> is_known = CountTracked(estimate);
  SearchLandmarks(local.landmarks, {}, is_known, estimate);
  const std::vector<ObjectId> objects = FindObjects(estimate);
  if (object_options_.guided_matching) {
    // What the local map has in sight is known by now: these are landmarks beyond it.
    for (const ObjectGuide& guide :
         GuideByObjects(*map_, *frame_, objects, is_known, object_options_)) {
      SearchLandmarks(guide.landmarks, guide.is_outside, is_known, estimate);
    }
  }
  PoseObjects found;
  if (object_options_.joint_pose) {
    found = TakePoseObjects(estimate, objects);
    estimate.unknown_objects = static_cast<int>(frame_->detections.size() - found.objects.size());
  }
  OptimizePose(estimate, found.objects);
  for (const LandmarkId landmark : estimate.landmarks) {
    if (landmark.IsValid()) {
      sightings_.CountFound(landmark);
    }
  }
  return Support(estimate) >= options_.min_inliers ? std::optional(std::move(estimate))
                                                   : std::nullopt;
}

std::vector<ObjectId> Tracker::FindObjects(const Estimate& estimate) const {
  const bool is_wanted = object_options_.joint_pose || object_options_.guided_matching;
  const bool may_show = object_options_.enabled && is_wanted && !frame_->detections.empty() &&
                        !map_->objects().empty();
  return may_show ? FindMappedObjects(*map_, sensor_, *frame_, estimate.cam_from_world,
                                      estimate.landmarks, object_options_.association)
                  : std::vector<ObjectId>();
}

PoseObjects Tracker::TakePoseObjects(const Estimate& estimate,
                                     std::span<const ObjectId> objects) const {
  return MakePoseObjects(*map_, sensor_, *frame_, estimate.cam_from_world, objects,
                         object_options_);
}

// Marks the landmarks found so far, by their ids.
std::vector<bool> Tracker::CountTracked(const Estimate& estimate) {
  std::vector<bool> is_known(map_->landmarks().NextId().value, false);
  for (const LandmarkId id : estimate.landmarks) {
    if (id.IsValid()) {
      is_known[id.value] = true;
      sightings_.CountVisible(id);
    }
  }
  return is_known;
}

// Looks for the landmarks that are not known yet, at the keypoints that are free and not excluded
// (one entry a keypoint, or none). They are known afterwards, found or not.
void Tracker::SearchLandmarks(std::span<const LandmarkId> landmarks,
                              std::span<const uint8_t> is_excluded, std::vector<bool>& is_known,
                              Estimate& estimate) {
  std::vector<Projection> projections;
  std::vector<LandmarkId> ids;
  for (const LandmarkId id : landmarks) {
    if (is_known[id.value]) {
      continue;
    }
    if (const auto projection =
            ExpectLandmark(sensor_, estimate.cam_from_world, map_->landmarks().At(id))) {
      is_known[id.value] = true;
      sightings_.CountVisible(id);
      projections.push_back(*projection);
      ids.push_back(id);
    }
  }
  std::vector<uint8_t> taken(frame_->features.size(), 0);
  for (size_t i = 0; i < taken.size(); ++i) {
    const bool is_excluded_here = !is_excluded.empty() && is_excluded[i] != 0;
    taken[i] = is_excluded_here || estimate.landmarks[i].IsValid() ? 1 : 0;
  }
  const std::vector<Match> matches = MatchByProjection(frame_->features, projections, taken,
                                                       {.max_distance = 100, .max_ratio = 0.8});
  for (const Match& match : matches) {
    estimate.landmarks[match.keypoint] = ids[match.query];
  }
}

void Tracker::OptimizePose(Estimate& estimate, std::span<const PoseObject> objects) const {
  const FrameFeatures& features = frame_->features;
  std::vector<PoseObservation> observations;
  std::vector<size_t> keypoints;
  for (size_t i = 0; i < estimate.landmarks.size(); ++i) {
    if (!estimate.landmarks[i].IsValid()) {
      continue;
    }
    const Keypoint& keypoint = features.keypoints[i];
    PoseObservation& observation = observations.emplace_back();
    observation.point = map_->landmarks().At(estimate.landmarks[i]).position;
    observation.measured << keypoint.undistorted.cast<double>(),
        static_cast<double>(keypoint.undistorted.x() - features.right_u[i]);
    observation.has_depth = features.right_u[i] >= 0.0f;
    observation.inverse_sigma2 =
        static_cast<double>(sensor_.levels.inverse_sigma2[static_cast<size_t>(keypoint.level)]);
    keypoints.push_back(i);
  }
  const JointPoseOptions options{.objects = object_options_.pose};
  const JointPoseResult joint =
      OptimizeJointPose(sensor_.camera, estimate.cam_from_world, observations, objects, options);
  const PoseOptimizationResult& result = joint.points;
  estimate.cam_from_world = result.cam_from_world;
  estimate.inliers = result.inlier_count;
  estimate.objects = joint.used_objects;
  for (size_t k = 0; k < keypoints.size(); ++k) {
    if (result.is_inlier[k] == 0) {
      estimate.landmarks[keypoints[k]] = LandmarkId();
    }
  }
}

}  // namespace hullslam
