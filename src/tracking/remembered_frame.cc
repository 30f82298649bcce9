// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/remembered_frame.h"

#include <cstddef>
#include <cstdint>
#include <optional>

#include "objects/constraint/object_constraint.h"
#include "tracking/frame_objects.h"
#include "tracking/pose_refinement.h"
#include "util/id_set.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr size_t kMostLandmarks = 400;
constexpr double kMinInlierShare = 0.5;  // least share of the landmarks that were found

// The detection with only the data that the residuals of the pose are computed from.
Detection Slim(Detection detection, const PinholeCamera& camera, const ObjectOptions& options) {
  if (TakesLines(options.pose.constraint.residual)) {
    detection.contour = {};
    if (!camera.IsDistorted()) {  // else ScaleToRaw needs the hull
      detection.hull = {};
    }
  }
  detection.embedding = {};
  detection.points = {};
  detection.keypoints = {};
  return detection;
}

// The landmark that has replaced the landmark, or the landmark itself; invalid if it was erased.
LandmarkId Newest(const Map& map, LandmarkId landmark) { return map.Resolve(landmark); }

// The same of an object; only mapped ones constrain poses.
ObjectId Newest(const Map& map, ObjectId id) {
  const ObjectId newest = map.Resolve(id);
  const ObjectLandmark* const object = map.objects().Find(newest);
  const bool is_mapped = object != nullptr && object->state == ObjectState::kMapped;
  return is_mapped ? newest : ObjectId();
}

template <typename Id>
std::vector<Id> Newest(const Map& map, std::vector<Id> ids) {
  for (Id& id : ids) {
    id = Newest(map, id);
  }
  return ids;
}

// The pose in the map that a culled keyframe has. Null if the frame did not become a keyframe, if
// that is still in the map, or if it was removed with its island.
std::optional<RelativePose> PoseOfCulled(const Map& map, FrameId frame) {
  const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(frame);
  const bool is_culled =
      keyframe && map.FindCulled(*keyframe) != nullptr && map.NearestAlive(*keyframe).IsValid();
  return is_culled ? std::optional(RelativePose{*keyframe, Rigid3(), map.ScaleOf(*keyframe)})
                   : std::nullopt;
}

void RefineFrame(const Map& map, const TrackingContext& context, const RememberedFrame& seen,
                 TrackedFrame& tracked) {
  if (const std::optional<RelativePose> culled = PoseOfCulled(map, tracked.frame)) {
    tracked.from_keyframe = culled;
  }
  if (!tracked.from_keyframe) {
    return;
  }
  PoseEstimate start;
  start.cam_from_world = map.CamFromWorld(*tracked.from_keyframe);
  start.landmarks = Newest(map, seen.landmarks);
  const PoseObjects objects = MakePoseObjects(map, context.sensor, seen.frame, start.cam_from_world,
                                              Newest(map, seen.objects), context.objects);
  const PoseEstimate refined =
      RefinePose(seen.frame, map, context, objects.objects, std::move(start));
  if (refined.EffectiveInliers() >= context.options.min_inliers &&
      refined.inliers >= kMinInlierShare * static_cast<double>(seen.landmarks.size())) {
    tracked.from_keyframe =
        map.RelativeTo(tracked.from_keyframe->reference, refined.cam_from_world);
  }
}

TrackedFrame& FrameOf(const RememberedFrame& seen, std::span<TrackedFrame> frames) {
  return frames[seen.frame.id.value - frames.front().frame.value];
}

}  // namespace

RememberedFrame Remember(const FrameReport& report, const PinholeCamera& camera,
                         const ObjectOptions& options) {
  RememberedFrame remembered;
  remembered.map_revision = report.map_revision;
  remembered.frame.id = report.tracked.frame;
  FrameFeatures& features = remembered.frame.features;
  const std::vector<uint32_t> found = Thin(IndicesOfValid(report.landmarks), kMostLandmarks);
  features.keypoints.reserve(found.size());
  features.depth.reserve(found.size());
  remembered.landmarks.reserve(found.size());
  for (const uint32_t i : found) {
    features.keypoints.push_back(report.frame->features.keypoints[i]);
    features.depth.push_back(report.frame->features.depth[i]);
    remembered.landmarks.push_back(report.landmarks[i]);
  }
  if (options.enabled && options.joint_pose) {
    const std::vector<uint32_t> seen = IndicesOfValid(report.objects);
    remembered.frame.detections.reserve(seen.size());
    remembered.objects.reserve(seen.size());
    for (const uint32_t i : seen) {
      remembered.frame.detections.push_back(Slim(report.frame->detections[i], camera, options));
      remembered.objects.push_back(report.objects[i]);
    }
  }
  return remembered;
}

void RefinePoses(const Map& map, const TrackingContext& context,
                 const std::list<RememberedFrame>& remembered, std::span<TrackedFrame> frames,
                 const Cancellation* cancellation, const ProgressCallback& on_progress) {
  int done = 0;
  for (const RememberedFrame& seen : remembered) {
    if (IsRequested(cancellation)) {
      return;
    }
    RefineFrame(map, context, seen, FrameOf(seen, frames));
    if (on_progress) {
      on_progress(++done, static_cast<int>(remembered.size()));
    }
  }
}

void RefineOldest(const Map& map, const TrackingContext& context, size_t most,
                  std::list<RememberedFrame>& remembered, std::span<TrackedFrame> frames) {
  while (remembered.size() > most) {
    RefineFrame(map, context, remembered.front(), FrameOf(remembered.front(), frames));
    remembered.pop_front();
  }
}

}  // namespace hullslam
