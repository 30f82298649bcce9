// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/shutter_correction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "frame/rolling_shutter.h"
#include "map/islands.h"
#include "util/statistics.h"

namespace hullslam {

void SeenDepths::Add(const Eigen::Vector2d& pixel, double depth) {
  if (!(depth > 0.0)) {
    return;
  }
  for (Mean* const mean : {&cells_[CellOf(pixel)], &all_}) {
    mean->sum += 1.0 / depth;
    mean->count += 1;
  }
}

double SeenDepths::InverseDepthAt(const Eigen::Vector2d& pixel) const {
  const Mean& cell = cells_[CellOf(pixel)];
  const Mean& mean = cell.count > 0 ? cell : all_;
  return mean.count > 0 ? mean.sum / mean.count : 0.0;
}

std::vector<double> SeenDepths::InverseDepths(const FrameFeatures& features) const {
  std::vector<double> inverse_depths(features.size());
  for (size_t i = 0; i < features.size(); ++i) {
    const auto depth = static_cast<double>(features.depth[i]);
    inverse_depths[i] = depth > 0.0
                            ? 1.0 / depth
                            : InverseDepthAt(features.keypoints[i].undistorted.cast<double>());
  }
  return inverse_depths;
}

size_t SeenDepths::CellOf(const Eigen::Vector2d& undistorted) const {
  const Eigen::Vector2d pixel = sensor_->camera.Distort(undistorted);
  const double x = (pixel.x() - bounds_.min_x) / (bounds_.max_x - bounds_.min_x);
  const double y = (pixel.y() - bounds_.min_y) / (bounds_.max_y - bounds_.min_y);
  const int column = std::clamp(static_cast<int>(x * kColumns), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>(y * kRows), 0, kRows - 1);
  return static_cast<size_t>(row * kColumns + column);
}

namespace {

// A velocity that is more than twice too large does more harm than none: the frame as read is then
// nearer to the truth than the corrected one. So the time between two images must be at least half
// of the usual interval.
constexpr double kShortestStep = 0.5;  // of the usual interval
// The camera cannot read an image before it has read the last one. This much of the usual interval
// is allowed for small errors of stamps.
constexpr double kStampError = 0.1;
// Over a long time T the mean velocity differs from the one at its end. For a sinusoidal motion it
// is nearer to it than none is up to a phase of w T = 2.4. Hands move to and fro about once a
// second (w = 2 pi / s), however often the camera takes images.
constexpr double kLongestStep = 0.4;  // s
// A velocity is kept for this multiple of the time in which it was measured (as in PredictMotion).
constexpr double kMostAge = 4.0;
// Largest median motion of points between two images, as a share of the smaller side of the image.
// With more, less than half of an image shows what the image before shows, so frames would not have
// been tracked one after the other.
constexpr double kMostMotion = 0.5;
// Largest median change of the motion from one image to the next, px in an image of this width or
// less. It grows with the width of larger images, as the windows of the motion model do: twice
// their radius, which is how far landmarks are always searched from where they are expected at the
// velocity until now. A larger change is that of missing or repeated images.
constexpr double kMostChange = 30.0;
constexpr double kWidthOfChange = 640.0;
// A correction is kept if it keeps this share of the measurements that agree. The bound of outliers
// is the 95 % quantile, so 5 % of the measurements may change sides by chance. A wrong velocity
// costs more than twice as many.
constexpr double kMinKept = 0.9;

// Whether images may be `duration` (s) apart, if they are so many frames apart.
bool IsPlausible(const Sensor& sensor, double duration, uint32_t frames) {
  const double interval = 1.0 / sensor.frames_per_second;
  const double shortest =
      std::max(kShortestStep * interval, std::abs(sensor.readout_time) - kStampError * interval);
  return duration >= frames * shortest && duration <= frames * kLongestStep;
}

// The median speed of the keypoints in the raw image, px/s, as the bounds of motion measure it.
double ImageSpeed(const FrameFeatures& features, const Sensor& sensor,
                  const PointVelocity& velocity, std::span<const double> inverse_depths) {
  constexpr size_t kEnough = 200;  // keypoints, for the median
  const size_t step = std::max<size_t>(1, features.size() / kEnough);
  std::vector<double> speeds;
  for (size_t i = 0; i < features.size(); i += step) {
    const Eigen::Vector2d pixel = features.keypoints[i].undistorted.cast<double>();
    const Eigen::Vector2d undistorted =
        ImageVelocity(sensor.camera, velocity, pixel, inverse_depths[i]);
    speeds.push_back((sensor.camera.DistortionJacobian(pixel) * undistorted).norm());
  }
  return speeds.empty() ? 0.0 : Median(std::move(speeds));
}

// Whether the image moves no faster with this velocity than images of a camera do.
bool IsPlausible(const Sensor& sensor, const FrameFeatures& features, const PointVelocity& velocity,
                 std::span<const double> inverse_depths) {
  const double most = kMostMotion * std::min(sensor.camera.width, sensor.camera.height);
  return ImageSpeed(features, sensor, velocity, inverse_depths) <= most * sensor.frames_per_second;
}

// Whether the velocity that corrected the last frames is still that of the camera.
bool IsKnown(const LastFrame& last, double timestamp) {
  return last.velocity && timestamp - last.velocity->timestamp <=
                              std::min(kMostAge * last.velocity->duration, kLongestStep);
}

// Whether a camera with the one velocity may have the other one in the next frame.
bool IsContinuous(const Sensor& sensor, const FrameFeatures& features, const PointVelocity& before,
                  const PointVelocity& velocity, std::span<const double> inverse_depths) {
  const PointVelocity change{velocity.angular - before.angular, velocity.linear - before.linear};
  const double most = kMostChange * std::max(1.0, sensor.camera.width / kWidthOfChange);
  return ImageSpeed(features, sensor, change, inverse_depths) <= most * sensor.frames_per_second;
}

// The frame with a global shutter, if the camera moved like this while it took so many frames. Null
// if no camera moves like this.
std::shared_ptr<const Frame> Correct(const Frame& frame, const Sensor& sensor,
                                     const CameraMotion& motion, uint32_t frames,
                                     std::span<const double> inverse_depths) {
  if (!IsPlausible(sensor, motion.duration, frames)) {
    return nullptr;
  }
  const PointVelocity velocity = MeanVelocity(motion.cam_from_last_cam, motion.duration);
  return IsPlausible(sensor, frame.features, velocity, inverse_depths)
             ? WithGlobalShutter(frame, sensor, velocity, inverse_depths)
             : nullptr;
}

// The depths in an image that shows these landmarks, one per keypoint.
SeenDepths DepthsOf(const FrameFeatures& features, std::span<const LandmarkId> landmarks,
                    const Rigid3& cam_from_world, const Map& map, const Sensor& sensor) {
  SeenDepths seen(sensor);
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (const Landmark* const landmark = map.landmarks().Find(landmarks[i])) {
      seen.Add(features.keypoints[i].undistorted.cast<double>(),
               (cam_from_world * landmark->position).z());
    }
  }
  return seen;
}

// The tracking of a frame that was tracked before its shutter was corrected. The landmarks found
// then suit the frame as it was. If too few of them agree with the corrected frame, the landmarks
// of the local map are searched in it, so that both frames are judged by landmarks chosen for
// themselves. If `is_first`, the map is a single frame that was not corrected, because nothing gave
// its velocity, so the map has the errors of its shutter and cannot judge. Null if the correction
// is not kept.
std::optional<LocalTracking> TrackCorrected(const Frame& corrected, const LocalTracking& tracked,
                                            bool is_first, const Map& map,
                                            const TrackingContext& context) {
  const auto is_kept = [&](const LocalTracking& tracking) {
    const int inliers = tracking.estimate.EffectiveInliers();
    return inliers >= context.options.min_inliers &&
           (is_first || IsCorrectionKept(inliers, tracked.estimate.EffectiveInliers()));
  };
  LocalTracking tracking = tracked;
  RefineTracking(corrected, map, context, tracking);
  if (!is_kept(tracking)) {
    tracking =
        TrackLocalMap(corrected, map, context, tracked.reference, std::move(tracking.estimate));
  }
  return is_kept(tracking) ? std::optional(std::move(tracking)) : std::nullopt;
}

}  // namespace

std::shared_ptr<const Frame> PredictGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last) {
  if (!sensor.HasSeveralTimes() || !IsKnown(last, frame->timestamp)) {
    return frame;
  }
  const SeenDepths seen =
      DepthsOf(last.frame->features, last.landmarks, last.cam_from_world, map, sensor);
  return WithGlobalShutter(*frame, sensor, last.velocity->velocity,
                           seen.InverseDepths(frame->features));
}

std::shared_ptr<const Frame> MeasureGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last,
                                                  const PoseEstimate& estimate) {
  const std::optional<CameraMotion> motion = MotionSince(last, *frame, estimate.cam_from_world);
  if (!sensor.HasSeveralTimes() || !motion) {
    return frame;
  }
  const SeenDepths seen =
      DepthsOf(frame->features, estimate.landmarks, estimate.cam_from_world, map, sensor);
  std::vector<double> inverse_depths = seen.InverseDepths(frame->features);
  for (size_t i = 0; i < inverse_depths.size(); ++i) {
    if (const Landmark* const landmark = map.landmarks().Find(estimate.landmarks[i])) {
      const double depth = (estimate.cam_from_world * landmark->position).z();
      inverse_depths[i] = depth > 0.0 ? 1.0 / depth : inverse_depths[i];
    }
  }
  if (IsKnown(last, frame->timestamp) &&
      !IsContinuous(sensor, frame->features, last.velocity->velocity,
                    MeanVelocity(motion->cam_from_last_cam, motion->duration), inverse_depths)) {
    return frame;
  }
  std::shared_ptr<const Frame> corrected = Correct(*frame, sensor, *motion, 1, inverse_depths);
  return corrected ? corrected : frame;
}

bool IsCorrectionKept(int agreeing, int before) { return agreeing >= kMinKept * before; }

CorrectedFrame CorrectShutter(const std::shared_ptr<const Frame>& as_read,
                              const std::shared_ptr<const Frame>& tracked, const Map& map,
                              const TrackingContext& context, const LastFrame& last,
                              LocalTracking& tracking) {
  std::shared_ptr<const Frame> corrected =
      MeasureGlobalShutter(as_read, map, context.sensor, last, tracking.estimate);
  if (corrected == as_read) {
    return {tracked, last.velocity};
  }
  const bool is_first =
      !IsKnown(last, as_read->timestamp) && map.IslandSize(IslandOf(map, tracking.reference)) == 1;
  std::optional<LocalTracking> found = TrackCorrected(*corrected, tracking, is_first, map, context);
  if (!found) {
    return {tracked, last.velocity};
  }
  tracking = *std::move(found);
  const std::optional<CameraMotion> motion =
      MotionSince(last, *as_read, tracking.estimate.cam_from_world);
  return {std::move(corrected),
          TimedVelocity{MeanVelocity(motion->cam_from_last_cam, motion->duration), motion->duration,
                        as_read->timestamp}};
}

bool CorrectFrames(const Sensor& sensor, InitialMap& map) {
  if (sensor.readout_time == 0.0) {
    return false;
  }
  std::vector<SeenDepths> seen(map.views.size(), SeenDepths(sensor));
  for (const InitialMap::Point& point : map.points) {
    for (const InitialMap::Observation& observation : point.observations) {
      const InitialMap::View& view = map.views[observation.view];
      seen[observation.view].Add(
          view.frame->features.keypoints[observation.keypoint].undistorted.cast<double>(),
          (view.cam_from_world * point.position).z());
    }
  }
  const std::vector<InitialMap::View> as_read = map.views;
  for (size_t i = 0; i < as_read.size(); ++i) {
    const InitialMap::View& before = as_read[i == 0 ? 0 : i - 1];
    const InitialMap::View& after = as_read[std::min(i + 1, as_read.size() - 1)];
    const CameraMotion motion{after.cam_from_world * Inverse(before.cam_from_world),
                              after.frame->timestamp - before.frame->timestamp};
    map.views[i].frame =
        Correct(*as_read[i].frame, sensor, motion, after.frame->id.value - before.frame->id.value,
                seen[i].InverseDepths(as_read[i].frame->features));
    if (map.views[i].frame == nullptr) {
      map.views = as_read;
      return false;
    }
  }
  return true;
}

}  // namespace hullslam
