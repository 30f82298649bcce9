// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/trajectory.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace hullslam {

Trajectory ComposeTrajectory(const Map& map, std::span<const TrackedFrame> frames) {
  Trajectory trajectory;
  for (const TrackedFrame& frame : frames) {
    if (frame.state != TrackingState::kTracked) {
      continue;
    }
    const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(frame.frame);
    const Rigid3 cam_from_world =
        keyframe ? map.CamFromWorld(*keyframe)
                 : frame.cam_from_reference * map.CamFromWorld(frame.reference);
    trajectory.push_back({frame.timestamp, Inverse(cam_from_world)});
  }
  return trajectory;
}

std::optional<Rigid3> InterpolatePose(const Trajectory& trajectory, double timestamp,
                                      double max_gap) {
  const auto after = std::lower_bound(
      trajectory.begin(), trajectory.end(), timestamp,
      [](const StampedPose& pose, double stamp) { return pose.timestamp < stamp; });
  if (after == trajectory.end()) {
    return std::nullopt;
  }
  if (after->timestamp == timestamp) {
    return after->world_from_cam;
  }
  if (after == trajectory.begin()) {
    return std::nullopt;
  }
  const StampedPose& before = *std::prev(after);
  const double gap = after->timestamp - before.timestamp;
  if (gap > max_gap) {
    return std::nullopt;
  }
  const double share = (timestamp - before.timestamp) / gap;
  const Rigid3& a = before.world_from_cam;
  const Rigid3& b = after->world_from_cam;
  return Rigid3(a.rotation.slerp(share, b.rotation),
                (1.0 - share) * a.translation + share * b.translation);
}

Trajectory KeyframeTrajectory(const Map& map) {
  Trajectory trajectory;
  map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    trajectory.push_back({keyframe.frame->timestamp, Inverse(keyframe.cam_from_world)});
  });
  return trajectory;
}

}  // namespace hullslam
