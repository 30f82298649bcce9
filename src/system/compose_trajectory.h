// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"

namespace hullslam {

// The poses of all tracked frames in the main island of the current map (Map::BeginIsland). The
// pose of a frame is relative to its reference keyframe, so it follows the map. A frame that is or
// was a keyframe has the keyframe's pose, until RefinePoses makes its pose relative to this
// keyframe. Frames without a pose are left out.
Trajectory ComposeTrajectory(const Map& map, std::span<const TrackedFrame> frames);

// Marks tracked frames that have no pose in the main island as lost.
void LoseFramesElsewhere(const Map& map, std::span<TrackedFrame> frames);

// Replaces frames by the results of EarlyFrames::Localise. A tracked frame stays as it was if the
// new pose finds clearly fewer of its landmarks. Such a pose is wrong: in front of a plane, for
// example, there are two solutions for a pose. The ids of `frames` must be consecutive.
void ReplaceEarlyFrames(std::span<const TrackedFrame> early, std::span<TrackedFrame> frames);

// The poses of the keyframes of the main island.
Trajectory KeyframeTrajectory(const Map& map);
// The poses of the keyframes of one session (SessionNumber).
Trajectory KeyframeTrajectory(const Map& map, size_t session);

}  // namespace hullslam
