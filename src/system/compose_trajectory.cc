// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/compose_trajectory.h"

#include <map>
#include <optional>

#include "map/islands.h"

namespace hullslam {
namespace {

// A final pose is wrong if it finds a smaller share of the landmarks that tracking found.
constexpr double kMinFoundAgain = 0.9;

// The pose of a tracked frame, if it is in this island.
std::optional<Rigid3> FindPose(const Map& map, IslandId island, const TrackedFrame& frame) {
  const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(frame.frame);
  // A frame of a culled keyframe whose pose was refined is relative to where the keyframe was.
  const bool is_refined = keyframe && !map.keyframes().Contains(*keyframe) && frame.from_keyframe &&
                          frame.from_keyframe->reference == keyframe;
  if (keyframe && !is_refined && IslandOf(map, *keyframe) == island) {
    return map.CamFromWorld(*keyframe);
  }
  if (frame.from_keyframe && IslandOf(map, frame.from_keyframe->reference) == island) {
    return map.CamFromWorld(*frame.from_keyframe);
  }
  return std::nullopt;
}

// The keyframes of the main island. Those of late masks have larger ids than those of later frames.
std::map<FrameId, const Keyframe*> KeyframesByFrame(const Map& map) {
  std::map<FrameId, const Keyframe*> keyframes;
  for (const KeyframeId id : KeyframesOf(map, MainIsland(map))) {
    const Keyframe& keyframe = map.keyframes().At(id);
    keyframes.emplace(keyframe.frame->id, &keyframe);
  }
  return keyframes;
}

}  // namespace

Trajectory ComposeTrajectory(const Map& map, std::span<const TrackedFrame> frames) {
  const IslandId island = MainIsland(map);
  Trajectory trajectory;
  for (const TrackedFrame& frame : frames) {
    if (frame.state != TrackingState::kTracked) {
      continue;
    }
    if (const std::optional<Rigid3> pose = FindPose(map, island, frame)) {
      trajectory.push_back({frame.timestamp, Inverse(*pose)});
    }
  }
  return trajectory;
}

void LoseFramesElsewhere(const Map& map, std::span<TrackedFrame> frames) {
  const IslandId island = MainIsland(map);
  for (TrackedFrame& frame : frames) {
    if (frame.state == TrackingState::kTracked && !FindPose(map, island, frame)) {
      frame.state = TrackingState::kLost;
      frame.from_keyframe.reset();
    }
  }
}

void ReplaceEarlyFrames(std::span<const TrackedFrame> early, std::span<TrackedFrame> frames) {
  for (const TrackedFrame& found : early) {
    TrackedFrame& frame = frames[found.frame.value - frames.front().frame.value];
    if (frame.state != TrackingState::kTracked || found.inliers >= kMinFoundAgain * frame.inliers) {
      const std::optional<Odometry> odometry = frame.odometry;
      frame = found;
      frame.odometry = odometry;
    }
  }
}

Trajectory KeyframeTrajectory(const Map& map) {
  Trajectory trajectory;
  for (const auto& [frame, keyframe] : KeyframesByFrame(map)) {
    trajectory.push_back({keyframe->frame->timestamp, Inverse(keyframe->cam_from_world)});
  }
  return trajectory;
}

Trajectory KeyframeTrajectory(const Map& map, size_t session) {
  Trajectory trajectory;
  for (const auto& [frame, keyframe] : KeyframesByFrame(map)) {
    if (SessionNumber(map.sessions(), frame) == session) {
      trajectory.push_back({keyframe->frame->timestamp, Inverse(keyframe->cam_from_world)});
    }
  }
  return trajectory;
}

}  // namespace hullslam
