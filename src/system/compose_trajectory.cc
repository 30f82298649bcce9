// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/compose_trajectory.h"

#include <optional>

namespace hullslam {

Trajectory ComposeTrajectory(const Map& map, std::span<const TrackedFrame> frames) {
  Trajectory trajectory;
  for (const TrackedFrame& frame : frames) {
    if (frame.state != TrackingState::kTracked) {
      continue;
    }
    if (const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(frame.frame)) {
      trajectory.push_back({frame.timestamp, Inverse(map.CamFromWorld(*keyframe))});
    } else if (frame.pose) {
      trajectory.push_back({frame.timestamp, Inverse(map.CamFromWorld(*frame.pose))});
    }
  }
  return trajectory;
}

Trajectory KeyframeTrajectory(const Map& map) {
  Trajectory trajectory;
  map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    trajectory.push_back({keyframe.frame->timestamp, Inverse(keyframe.cam_from_world)});
  });
  return trajectory;
}

Trajectory KeyframeTrajectory(const Map& map, size_t session) {
  Trajectory trajectory;
  map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    if (SessionNumber(map.sessions(), keyframe.frame->id) == session) {
      trajectory.push_back({keyframe.frame->timestamp, Inverse(keyframe.cam_from_world)});
    }
  });
  return trajectory;
}

}  // namespace hullslam
