// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/early_frames.h"

#include <algorithm>
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

// The keyframe of the frame's session that is nearest to it in time. If there is none, one of an
// earlier session, whose time stamps say nothing about the frame.
KeyframeId NearestInTime(const Map& map, const Frame& frame) {
  const auto session_of = [&](FrameId id) { return SessionNumber(map.sessions(), id); };
  const size_t session = session_of(frame.id);
  KeyframeId nearest;
  std::pair smallest(true, std::numeric_limits<double>::infinity());  // is elsewhere, seconds
  for (const auto& [id, keyframe] : map.keyframes()) {
    const std::pair gap(session_of(keyframe.frame->id) != session,
                        std::abs(keyframe.frame->timestamp - frame.timestamp));
    if (gap < smallest) {
      smallest = gap;
      nearest = id;
    }
  }
  return nearest;
}

// Finds a frame in the map. `before` is the last frame that was found; if this one is found, it
// takes its place. The result has no pose if the frame is a keyframe.
std::optional<TrackedFrame> LocaliseFrame(const Map& map, const TrackingContext& context,
                                          const std::shared_ptr<const Frame>& frame,
                                          LastFrame& before) {
  constexpr std::array<PoseSource*, 2> kSources = {&PoseByReferenceKeyframe, &PoseByRelocalisation};
  TrackedFrame tracked;
  tracked.frame = frame->id;
  tracked.timestamp = frame->timestamp;
  tracked.state = TrackingState::kTracked;
  const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(frame->id);
  if (keyframe && IslandOf(map, *keyframe).IsValid()) {
    before.frame = frame;
    before.cam_from_world = map.CamFromWorld({*keyframe, Rigid3(), map.ScaleOf(*keyframe)});
    return tracked;
  }
  LastFrame nearest;
  nearest.reference = NearestInTime(map, *frame);
  nearest.frame = map.keyframes().At(nearest.reference).frame;
  nearest.cam_from_world = map.keyframes().At(nearest.reference).cam_from_world;
  std::optional<ConfirmedPose> found =
      FindConfirmedPose(*frame, map, context, nearest, kSources).found;
  if (!found) {
    return std::nullopt;
  }
  CorrectShutter(frame, frame, map, context, before, found->tracking);
  const PoseEstimate& estimate = found->tracking.estimate;
  before.frame = frame;
  before.cam_from_world = estimate.cam_from_world;
  tracked.from_keyframe = map.RelativeTo(found->tracking.reference, estimate.cam_from_world);
  tracked.cam_from_world = estimate.cam_from_world;
  tracked.inliers = estimate.inliers;
  return tracked;
}

}  // namespace

void EarlyFrames::Keep(std::shared_ptr<const Frame> frame, bool is_tracked) {
  if (frames_.size() == kMostFrames) {
    const auto tracked = std::find_if(frames_.begin(), frames_.end(),
                                      [](const Kept& kept) { return kept.is_tracked; });
    frames_.erase(tracked != frames_.end() ? tracked : frames_.begin());
  }
  frames_.push_back({std::move(frame), is_tracked});
}

std::vector<TrackedFrame> EarlyFrames::Localise(const Map& map, const TrackingContext& context,
                                                const Cancellation* cancellation,
                                                const ProgressCallback& on_progress) {
  std::vector<TrackedFrame> localised;
  LastFrame before;  // the last frame before the current one that was found
  int done = 0;
  for (const Kept& kept : frames_) {
    if (IsRequested(cancellation)) {
      break;
    }
    if (std::optional<TrackedFrame> tracked = LocaliseFrame(map, context, kept.frame, before)) {
      localised.push_back(std::move(*tracked));
    }
    if (on_progress) {
      on_progress(++done, static_cast<int>(frames_.size()));
    }
  }
  frames_.clear();
  return localised;
}

}  // namespace hullslam
