// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/shutter_correction.h"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "frame/rolling_shutter.h"
#include "tracking/seen_depths.h"

namespace hullslam {
namespace {

// The depths in an image that shows these landmarks, one per keypoint.
SeenDepths DepthsOf(const FrameFeatures& features, std::span<const LandmarkId> landmarks,
                    const Rigid3& cam_from_world, const Map& map, const Sensor& sensor) {
  SeenDepths seen(sensor.bounds);
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (const Landmark* const landmark = map.landmarks().Find(landmarks[i])) {
      seen.Add(features.keypoints[i].undistorted.cast<double>(),
               (cam_from_world * landmark->position).z());
    }
  }
  return seen;
}

}  // namespace

std::shared_ptr<const Frame> PredictGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last) {
  if (sensor.readout_time == 0.0 || !PredictMotion(last, frame->timestamp)) {
    return frame;
  }
  const SeenDepths seen =
      DepthsOf(last.frame->features, last.landmarks, last.cam_from_world, map, sensor);
  return WithGlobalShutter(*frame, sensor,
                           MeanVelocity(last.motion->cam_from_last_cam, last.motion->duration),
                           seen.InverseDepths(frame->features));
}

std::shared_ptr<const Frame> MeasureGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last,
                                                  const PoseEstimate& estimate) {
  const std::optional<CameraMotion> motion = MotionSince(last, *frame, estimate.cam_from_world);
  if (sensor.readout_time == 0.0 || !motion) {
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
  return WithGlobalShutter(
      *frame, sensor, MeanVelocity(motion->cam_from_last_cam, motion->duration), inverse_depths);
}

std::shared_ptr<const Frame> CorrectShutter(const std::shared_ptr<const Frame>& as_read,
                                            const Map& map, const TrackingContext& context,
                                            const LastFrame& last, LocalTracking& tracking) {
  std::shared_ptr<const Frame> corrected =
      MeasureGlobalShutter(as_read, map, context.sensor, last, tracking.estimate);
  if (corrected != as_read) {
    RefineTracking(*corrected, map, context, tracking);
  }
  return corrected;
}

void CorrectViews(const Sensor& sensor, InitialMap& map) {
  if (sensor.readout_time == 0.0) {
    return;
  }
  std::vector<SeenDepths> seen(map.views.size(), SeenDepths(sensor.bounds));
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
    map.views[i].frame =
        WithGlobalShutter(*as_read[i].frame, sensor,
                          MeanVelocity(after.cam_from_world * Inverse(before.cam_from_world),
                                       after.frame->timestamp - before.frame->timestamp),
                          seen[i].InverseDepths(as_read[i].frame->features));
  }
}

}  // namespace hullslam
