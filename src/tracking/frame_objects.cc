// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/frame_objects.h"

#include <algorithm>
#include <utility>

#include "geometry/polygon.h"
#include "hullslam/frame/instance_mask.h"
#include "objects/association.h"
#include "objects/constraint/misfit.h"
#include "objects/constraint/object_constraint.h"
#include "objects/resolved_observation.h"
#include "objects/validity.h"
#include "util/lists.h"

namespace hullslam {
namespace {

Rigid3 RightCamera(const Sensor& sensor, Rigid3 cam_from_world) {
  cam_from_world.translation.x() -= sensor.baseline();
  return cam_from_world;
}

// The lines whose excess is known, moved by the excess. Empty if these are fewer than half.
std::vector<SilhouetteLine> KnownLines(const Sensor& sensor, const Rigid3& cam_from_world,
                                       const ObjectLandmark& object,
                                       std::span<const SilhouetteLine> lines,
                                       const MisfitOptions& options) {
  std::vector<uint8_t> known;
  const std::vector<SilhouetteLine> moved =
      CompensateLines(sensor.camera, cam_from_world, object, lines, KeyframeId(), known, options);
  std::vector<SilhouetteLine> kept;
  for (size_t i = 0; i < moved.size(); ++i) {
    // A one-sided line does not show how far the object reaches, so there is nothing to compensate.
    if (known[i] != 0 && !moved[i].is_one_sided) {
      kept.push_back(moved[i]);
    }
  }
  return 2 * kept.size() >= lines.size() ? kept : std::vector<SilhouetteLine>();
}

}  // namespace

std::vector<ObjectId> FindMappedObjects(const Frame& frame, const Map& map,
                                        const TrackingContext& context,
                                        const PoseEstimate& estimate, IslandId island) {
  const ObjectOptions& objects = context.objects;
  const bool is_used =
      objects.joint_pose || objects.guided_matching || context.options.keyframes_for_objects;
  const bool is_wanted = objects.enabled && is_used;
  if (!is_wanted || frame.detections.empty() || map.objects().empty()) {
    return std::vector<ObjectId>(frame.detections.size());
  }
  return AssociateDetections({.map = map,
                              .index = context.object_index,
                              .sensor = context.sensor,
                              .frame = frame,
                              .cam_from_world = estimate.cam_from_world,
                              .island = island,
                              .landmarks = estimate.landmarks,
                              .scope = AssociationScope::kMapped},
                             objects.association);
}

PoseObjects MakePoseObjects(const Map& map, const Sensor& sensor, const Frame& frame,
                            const Rigid3& cam_from_world, std::span<const ObjectId> ids,
                            const ObjectOptions& options) {
  PoseObjects found;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (!ids[i].IsValid()) {
      continue;
    }
    const ObjectLandmark& object = map.objects().At(ids[i]);
    const Detection& detection = frame.detections[i];
    PoseObject pose_object{object.ellipsoid, &detection, {}, object.compensated_px};
    if (options.misfit_compensation && TakesLines(options.pose.constraint.residual)) {
      pose_object.lines =
          KnownLines(sensor, cam_from_world, object, detection.lines, options.misfit);
      pose_object.right_lines = KnownLines(sensor, RightCamera(sensor, cam_from_world), object,
                                           detection.right_lines, options.misfit);
    }
    if (pose_object.lines.empty()) {
      pose_object.lines = detection.lines;
      pose_object.right_lines = detection.right_lines;
      pose_object.misfit_px = object.misfit_px;
    }
    found.ids.push_back(ids[i]);
    found.objects.push_back(std::move(pose_object));
  }
  return found;
}

namespace {

std::vector<uint8_t> KeypointsOutside(const Frame& frame, const Detection& detection) {
  const std::vector<Keypoint>& keypoints = frame.features.keypoints;
  std::vector<uint8_t> is_outside(keypoints.size(), 1);
  for (size_t i = 0; i < keypoints.size(); ++i) {
    const Eigen::Vector2d pixel = keypoints[i].undistorted.cast<double>();
    if (detection.box.squaredExteriorDistance(pixel) <= kMaskMarginPx * kMaskMarginPx &&
        IsInOrNearConvex(detection.hull, pixel, kMaskMarginPx)) {
      is_outside[i] = 0;
    }
  }
  return is_outside;
}

}  // namespace

std::vector<LandmarkId> LandmarksOn(const Map& map, const ObjectLandmark& object,
                                    const IdSet<LandmarkId>& known, const ObjectOptions& options) {
  const std::vector<ResolvedObservation> views =
      ResolveObservations(map, object, static_cast<size_t>(options.guide.views));
  if (views.empty()) {
    return {};
  }
  std::vector<LandmarkId> landmarks;
  for (const ResolvedObservation& view : views) {
    const Keyframe& keyframe = map.keyframes().At(view.keyframe);
    for (const uint32_t keypoint : view.detection->keypoints) {
      const LandmarkId landmark = keyframe.landmarks[keypoint];
      if (landmark.IsValid() && !known.Contains(landmark)) {
        landmarks.push_back(landmark);
      }
    }
  }
  SortUnique(landmarks);
  const Ellipsoid& ellipsoid = object.ellipsoid;
  const double margin = NearSurface(
      ellipsoid, MeanDistance(views, ellipsoid.world_from_object.translation), options.validity);
  std::erase_if(landmarks, [&](LandmarkId id) {
    return ellipsoid.RadialDistance(map.landmarks().At(id).position) > margin;
  });
  return landmarks;
}

std::vector<ObjectGuide> GuideByObjects(const Map& map, const Frame& frame,
                                        std::span<const ObjectId> objects,
                                        const IdSet<LandmarkId>& known,
                                        const ObjectOptions& options) {
  std::vector<ObjectGuide> guides;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].IsValid()) {
      continue;
    }
    std::vector<LandmarkId> landmarks =
        LandmarksOn(map, map.objects().At(objects[i]), known, options);
    if (!landmarks.empty()) {
      guides.push_back({std::move(landmarks), KeypointsOutside(frame, frame.detections[i])});
    }
  }
  return guides;
}

}  // namespace hullslam
