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

constexpr double kMaxExtrapolation = 4.0;  // time step over the duration of the measured motion

// Replaces each landmark by the one that has replaced it in the map. If two of them were merged,
// only the first keypoint keeps the result, because a frame observes a landmark at one keypoint
// only.
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

std::optional<Odometry> OdometryChain::Add(const TrackedFrame& tracked, const LastFrame& last,
                                           const std::optional<MotionPrior>& prior,
                                           uint32_t corrections) {
  const bool is_tracked = tracked.state == TrackingState::kTracked;
  const double time_step = tracked.timestamp - std::exchange(timestamp_, tracked.timestamp);
  const bool was_corrected = std::exchange(corrections_, corrections) != corrections;
  if (!odometry_) {
    if (is_tracked) {
      odometry_.emplace();
      odometry_->odom_from_cam = tracked.world_from_cam();
      odometry_->corrected_at = tracked.frame;
    }
    return odometry_;
  }
  Rigid3 cam_from_last;
  if (is_tracked && last.motion) {
    odometry_->step = OdometryStep::kMeasured;
    cam_from_last = last.motion->cam_from_last_cam;
    cam_from_last.translation /= last.map_per_odometry;
    motion_ = {cam_from_last, time_step};
    end_of_prediction_ = tracked.timestamp + kMaxExtrapolation * time_step;
  } else if (prior) {
    odometry_->step = OdometryStep::kPrior;
    cam_from_last = prior->cam_from_last_cam;
  } else if (tracked.timestamp <= end_of_prediction_) {
    odometry_->step = OdometryStep::kPredicted;
    cam_from_last = PartOfMotion(motion_.cam_from_last_cam, time_step / motion_.duration);
  } else {
    odometry_->step = OdometryStep::kStopped;
  }
  odometry_->odom_from_cam = odometry_->odom_from_cam * Inverse(cam_from_last);
  odometry_->linear_velocity = -MeanVelocity(cam_from_last, time_step).linear;
  odometry_->angular_velocity = -MeanVelocity(cam_from_last, time_step).angular;
  if (is_tracked) {
    odometry_->map_from_odom = tracked.world_from_cam() * Inverse(odometry_->odom_from_cam);
    const bool is_continued =
        odometry_->step == OdometryStep::kMeasured || tracked.prior == PriorUse::kAlone;
    if (was_corrected || !is_continued) {
      odometry_->corrected_at = tracked.frame;
    }
  }
  return odometry_;
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
