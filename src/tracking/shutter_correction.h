// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "tracking/last_frame.h"
#include "tracking/local_map_tracking.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// These functions return the frame as a global shutter would have taken it (WithGlobalShutter), or
// the frame itself if the shutter is global (Sensor::readout_time is 0) or the velocity of the
// camera is not known. `last` is up to date with the map (FollowMap).

// For a frame that is not tracked yet. Assumes that the camera keeps the velocity of the last
// frame, and that the depths are those of the last frame at the same pixels.
std::shared_ptr<const Frame> PredictGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last);

// For a tracked frame. The velocity is that of the motion since the last frame, and the depths are
// those of the landmarks that were found. `frame` is the frame as read, not the predicted one.
std::shared_ptr<const Frame> MeasureGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last,
                                                  const PoseEstimate& estimate);

// Like MeasureGlobalShutter. If the corrected frame differs from the frame as read, the pose is
// optimised again with it.
std::shared_ptr<const Frame> CorrectShutter(const std::shared_ptr<const Frame>& as_read,
                                            const Map& map, const TrackingContext& context,
                                            const LastFrame& last, LocalTracking& tracking);

// For the two or more views of an initial map. The velocity of a view is that of the motion from
// the view before it to the view after it.
void CorrectViews(const Sensor& sensor, InitialMap& map);

}  // namespace hullslam
