// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "tracking/last_frame.h"
#include "tracking/local_map_tracking.h"
#include "tracking/pose_estimate.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// These functions return the frame as a global shutter would have taken it (WithGlobalShutter), or
// the frame itself if the shutter is global (Sensor::readout_time is 0) or the velocity of the
// camera is not known. `last` is up to date with the map (FollowMap).

// For a frame that is not tracked yet: the camera keeps the velocity of the last frame, and what it
// shows is as far away as what the last frame showed there.
std::shared_ptr<const Frame> PredictGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last);

// For a tracked frame: the velocity is that of the motion since the last frame, and the landmarks
// that were found tell the depths. `frame` is as it was read, not as it was predicted.
std::shared_ptr<const Frame> MeasureGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last,
                                                  const PoseEstimate& estimate);

// For a frame whose pose was found: as MeasureGlobalShutter. Optimises the pose with the frame that
// it returns, if that is another one.
std::shared_ptr<const Frame> CorrectShutter(const std::shared_ptr<const Frame>& as_read,
                                            const Map& map, const TrackingContext& context,
                                            const LastFrame& last, LocalTracking& tracking);

// For the two or more views of an initial map: the velocity of a view is that of the motion from
// the view before it to the one after it.
void CorrectViews(const Sensor& sensor, InitialMap& map);

}  // namespace hullslam
