// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/early_frames.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "map/islands.h"
#include "tracking/confirmed_pose.h"
#include "tracking/last_frame.h"
#include "tracking/shutter_correction.h"

namespace hullslam {
namespace {

constexpr size_t kMostFrames = 300;

KeyframeId NearestInTime(const Map& map, double timestamp) {
  KeyframeId nearest;
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [id, keyframe] : map.keyframes()) {
    const double gap = std::abs(keyframe.frame->timestamp - timestamp);
    if (gap < smallest) {
      smallest = gap;
      nearest = id;
    }
  }
  return nearest;
}

}  // namespace

void EarlyFrames::Keep(std::shared_ptr<const Frame> frame) {
  if (frames_.size() == kMostFrames) {
    frames_.erase(frames_.begin());
  }
  frames_.push_back(std::move(frame));
}

std::vector<TrackedFrame> EarlyFrames::Localise(const Map& map, const TrackingContext& context) {
  constexpr std::array<PoseSource*, 2> kSources = {&PoseByReferenceKeyframe, &PoseByRelocalisation};
  std::vector<TrackedFrame> localised;
  LastFrame before;  // the last frame before the current one that was found
  for (const std::shared_ptr<const Frame>& frame : frames_) {
    TrackedFrame tracked;
    tracked.frame = frame->id;
    tracked.timestamp = frame->timestamp;
    tracked.state = TrackingState::kTracked;
    const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(frame->id);
    if (keyframe && IslandOf(map, *keyframe).IsValid()) {
      localised.push_back(tracked);
      before.frame = frame;
      before.cam_from_world = map.CamFromWorld({*keyframe, Rigid3(), map.ScaleOf(*keyframe)});
      continue;
    }
    LastFrame nearest;
    nearest.reference = NearestInTime(map, frame->timestamp);
    nearest.frame = map.keyframes().At(nearest.reference).frame;
    nearest.cam_from_world = map.keyframes().At(nearest.reference).cam_from_world;
    if (auto found = FindConfirmedPose(*frame, map, context, nearest, kSources)) {
      CorrectShutter(frame, map, context, before, found->tracking);
      const PoseEstimate& estimate = found->tracking.estimate;
      before.frame = frame;
      before.cam_from_world = estimate.cam_from_world;
      tracked.from_keyframe = map.RelativeTo(found->tracking.reference, estimate.cam_from_world);
      tracked.cam_from_world = estimate.cam_from_world;
      tracked.inliers = estimate.inliers;
      localised.push_back(tracked);
    }
  }
  frames_.clear();
  return localised;
}

}  // namespace hullslam
