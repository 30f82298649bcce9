// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "tracking/keyframe_policy.h"
#include "tracking/last_frame.h"
#include "tracking/local_map_tracking.h"

namespace hullslam {

// The number of landmarks of the estimate that have a sufficient observation weight, with those
// that its objects stand for. They are in the island of the keyframe `reference`.
int CountConfirmed(const Map& map, KeyframeId reference, const PoseEstimate& estimate);

// What a frame and its local map tell about whether a keyframe is needed; `last` is the frame
// before. The other members of the result keep their defaults.
KeyframeEvidence GatherEvidence(const Frame& frame, const Map& map, const Sensor& sensor,
                                const LocalTracking& tracking, const LastFrame& last);

}  // namespace hullslam
