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
    if (!camera.IsDistorted()) {                        // else ScaleToRaw needs the hull
      detection.hull = std::vector<Eigen::Vector2d>();  // {} would keep the memory
    }
  }
  detection.embedding = std::vector<float>();
  detection.points = {};
  detection.keypoints = std::vector<uint32_t>();
  return detection;
}

// The objects that have replaced them; invalid where there is no mapped one to constrain poses.
std::vector<ObjectId> Newest(const Map& map, std::vector<ObjectId> ids) {
  for (ObjectId& id : ids) {
    id = map.Resolve(id);
    const ObjectLandmark* const object = map.objects().Find(id);
    id = object != nullptr && object->state == ObjectState::kMapped ? id : ObjectId();
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
  for (const RememberedFrame::Point& point : seen.points) {
    start.landmarks.push_back(map.Resolve(point.landmark));
  }
  const Frame frame = seen.MakeFrame();
  const PoseObjects objects = MakePoseObjects(map, context.sensor, frame, start.cam_from_world,
                                              Newest(map, seen.objects), context.objects);
  const PoseEstimate refined = RefinePose(frame, map, context, objects.objects, std::move(start));
  if (refined.EffectiveInliers() >= context.options.min_inliers &&
      refined.inliers >= kMinInlierShare * static_cast<double>(seen.points.size())) {
    tracked.from_keyframe =
        map.RelativeTo(tracked.from_keyframe->reference, refined.cam_from_world);
  }
}

TrackedFrame& FrameOf(const RememberedFrame& seen, std::span<TrackedFrame> frames) {
  return frames[seen.id.value - frames.front().frame.value];
}

}  // namespace

Frame RememberedFrame::MakeFrame() const {
  Frame frame;
  frame.id = id;
  frame.detections = detections;
  for (size_t i = 0; i < points.size(); ++i) {
    frame.features.keypoints.push_back({.undistorted = points[i].undistorted, .level = levels[i]});
    frame.features.depth.push_back(points[i].depth);
  }
  return frame;
}

RememberedFrame Remember(const FrameReport& report, const PinholeCamera& camera,
                         const ObjectOptions& options) {
  RememberedFrame remembered;
  remembered.map_revision = report.map_revision;
  remembered.id = report.tracked.frame;
  const FrameFeatures& features = report.frame->features;
  const std::vector<uint32_t> found = Thin(IndicesOfValid(report.landmarks), kMostLandmarks);
  remembered.points.reserve(found.size());
  remembered.levels.reserve(found.size());
  for (const uint32_t i : found) {
    const Keypoint& keypoint = features.keypoints[i];
    remembered.points.push_back({keypoint.undistorted, features.depth[i], report.landmarks[i]});
    remembered.levels.push_back(static_cast<uint8_t>(keypoint.level));
  }
  if (options.enabled && options.joint_pose) {
    const std::vector<uint32_t> seen = IndicesOfValid(report.objects);
    remembered.detections.reserve(seen.size());
    remembered.objects.reserve(seen.size());
    for (const uint32_t i : seen) {
      remembered.detections.push_back(Slim(report.frame->detections[i], camera, options));
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
