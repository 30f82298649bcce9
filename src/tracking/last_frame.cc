// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/last_frame.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "hullslam/util/check.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

// Replaces each landmark by the one that has replaced it in the map. If two of them were merged,
// only the first keypoint keeps the result: a frame observes a landmark at one keypoint only.
void ResolveAll(const Map& map, std::vector<LandmarkId>& landmarks) {
  IdSet<LandmarkId> taken;
  for (LandmarkId& landmark : landmarks) {
    landmark = map.Resolve(landmark);
    if (landmark.IsValid() && !taken.Insert(landmark)) {
      landmark = LandmarkId();
    }
  }
}

}  // namespace

LastFrame FollowMap(const Map& map, LastFrame last) {
  if (last.pose) {
    const double change = map.ScaleOf(last.pose->reference) / last.pose->reference_scale;
    last.map_per_odometry *= change / std::exchange(last.followed_change, change);
    if (last.motion) {
      last.motion->cam_from_last_cam.translation *= change;
    }
    if (last.velocity) {
      last.velocity->velocity.linear *= change;
    }
  }
  const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(last.frame->id);
  if (keyframe && map.keyframes().Contains(*keyframe)) {
    // The map may have replaced the frame by one with fewer keypoints.
    last.frame = map.keyframes().At(*keyframe).frame;
    last.landmarks = map.keyframes().At(*keyframe).landmarks;
    last.reference = *keyframe;
    last.pose = RelativePose{*keyframe, Rigid3(), map.ScaleOf(*keyframe)};
    last.followed_change = 1.0;
  }
  Check(last.pose.has_value(), "the map does not know the last frame");
  last.reference = map.NearestAlive(last.reference);
  ResolveAll(map, last.landmarks);
  last.cam_from_world = map.CamFromWorld(*last.pose);
  return last;
}

std::optional<CameraMotion> MotionSince(const LastFrame& last, const Frame& frame,
                                        const Rigid3& cam_from_world) {
  if (last.frame == nullptr || frame.id.value != last.frame->id.value + 1) {
    return std::nullopt;
  }
  return CameraMotion{cam_from_world * Inverse(last.cam_from_world),
                      frame.timestamp - last.frame->timestamp};
}

std::optional<MotionPrior> MotionAhead(const LastFrame& last, const Frame& frame) {
  const bool is_next = last.frame != nullptr && frame.id.value == last.frame->id.value + 1;
  if (is_next || !last.ahead || !frame.motion) {
    return is_next ? frame.motion : std::nullopt;
  }
  const Rigid3& step = frame.motion->cam_from_last_cam;
  return MotionPrior{step * last.ahead->cam_from_last_cam, last.ahead->last_timestamp,
                     InAxesOf(step, last.ahead->covariance) + frame.motion->covariance};
}

std::optional<Rigid3> PredictMotion(const LastFrame& last, double timestamp) {
  if (last.ahead) {
    return last.ahead->cam_from_last_cam;
  }
  if (!last.motion) {
    return std::nullopt;
  }
  const double time_step = timestamp - last.frame->timestamp;
  if (std::abs(time_step) > kMaxExtrapolation * std::abs(last.motion->duration)) {
    return std::nullopt;
  }
  return PartOfMotion(last.motion->cam_from_last_cam, time_step / last.motion->duration);
}

double ShareInImage(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                    std::span<const LandmarkId> landmarks) {
  size_t count = 0;
  size_t inside = 0;
  for (const LandmarkId id : landmarks) {
    const Landmark* const landmark = id.IsValid() ? map.landmarks().Find(id) : nullptr;
    if (landmark == nullptr) {
      continue;
    }
    ++count;
    const Eigen::Vector3d point = cam_from_world * landmark->position;
    const bool is_inside = point.z() > 0.0 && sensor.Sees(sensor.camera.Project(point));
    inside += is_inside ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(inside) / static_cast<double>(count) : 1.0;
}

double NextOverlap(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                   KeyframeId reference, const LastFrame& last) {
  const std::vector<LandmarkId>& landmarks = map.keyframes().At(reference).landmarks;
  return ShareInImage(map, sensor, cam_from_world, landmarks) +
         ShareInImage(map, sensor, cam_from_world, last.landmarks) - 1.0;
}

}  // namespace hullslam
