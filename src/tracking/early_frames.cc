// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/early_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "map/islands.h"
#include "places/landmark_search.h"
#include "tracking/last_frame.h"
#include "tracking/shutter_correction.h"
#include "tracking/sources/confirmed_pose.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kMostFrames = 300;

// The keyframe of the frame's session that is nearest to it in time. Invalid if there is none: the
// time stamps of earlier sessions say nothing about the frame.
KeyframeId NearestInTime(const Map& map, const Frame& frame) {
  const auto session_of = [&](FrameId id) { return SessionNumber(map.sessions(), id); };
  const size_t session = session_of(frame.id);
  KeyframeId nearest;
  double smallest = std::numeric_limits<double>::infinity();  // s
  for (const auto& [id, keyframe] : map.keyframes()) {
    const double gap = std::abs(keyframe.frame->timestamp - frame.timestamp);
    if (session_of(keyframe.frame->id) == session && gap < smallest) {
      smallest = gap;
      nearest = id;
    }
  }
  return nearest;
}

// A frame that was found. The result has no relative pose if the frame is a keyframe.
struct FoundFrame {
  TrackedFrame tracked;
  LastFrame last;  // to find the next frame
};

TrackedFrame MakeTracked(const Frame& frame) {
  TrackedFrame tracked;
  tracked.frame = frame.id;
  tracked.timestamp = frame.timestamp;
  tracked.state = TrackingState::kTracked;
  return tracked;
}

FoundFrame MakeFound(const Map& map, const std::shared_ptr<const Frame>& frame,
                     LocalTracking tracking) {
  FoundFrame found{.tracked = MakeTracked(*frame), .last = {}};
  PoseEstimate& estimate = tracking.estimate;
  found.tracked.from_keyframe = map.RelativeTo(tracking.reference, estimate.cam_from_world);
  found.tracked.cam_from_world = estimate.cam_from_world;
  found.tracked.inliers = estimate.inliers;
  found.last.frame = frame;
  found.last.landmarks = std::move(estimate.landmarks);
  found.last.reference = tracking.reference;
  found.last.cam_from_world = estimate.cam_from_world;
  return found;
}

// The frame if it is a keyframe of the map, perhaps a culled one.
std::optional<FoundFrame> PoseOfKeyframe(const Map& map,
                                         const std::shared_ptr<const Frame>& frame) {
  const std::optional<KeyframeId> id = map.KeyframeOfFrame(frame->id);
  if (!id || !IslandOf(map, *id).IsValid()) {
    return std::nullopt;
  }
  FoundFrame found{.tracked = MakeTracked(*frame), .last = {}};
  found.last.frame = frame;
  found.last.reference = map.NearestAlive(*id);
  found.last.cam_from_world = map.CamFromWorld({*id, Rigid3(), map.ScaleOf(*id)});
  if (const Keyframe* const keyframe = map.keyframes().Find(*id)) {
    found.last.frame = keyframe->frame;  // perhaps with fewer keypoints
    found.last.landmarks = keyframe->landmarks;
  }
  return found;
}

// Seeks a frame at the keyframe that is nearest in time, and everywhere by words. `before` is the
// last frame before it that was found.
std::optional<FoundFrame> FindFrame(const Map& map, const TrackingContext& context,
                                    const std::shared_ptr<const Frame>& frame,
                                    const LastFrame& before) {
  constexpr std::array<PoseSource*, 2> kSources = {&PoseByReferenceKeyframe, &PoseByRelocalisation};
  LastFrame nearest;
  std::span<PoseSource* const> sources = kSources;
  nearest.reference = NearestInTime(map, *frame);
  if (nearest.reference.IsValid()) {
    nearest.frame = map.keyframes().At(nearest.reference).frame;
    nearest.cam_from_world = map.keyframes().At(nearest.reference).cam_from_world;
  } else {
    sources = sources.subspan(1);
  }
  std::optional<ConfirmedPose> found =
      FindConfirmedPose(*frame, map, context, nearest, sources).found;
  if (!found) {
    return std::nullopt;
  }
  CorrectShutter(frame, frame, map, context, before, found->tracking);
  return MakeFound(map, frame, std::move(found->tracking));
}

// Tracks a frame from the one after it. `later`, the one after that, gives the velocity if found.
std::optional<FoundFrame> TrackBack(const Map& map, const TrackingContext& context,
                                    const std::shared_ptr<const Frame>& frame, LastFrame after,
                                    const FoundFrame* later) {
  constexpr std::array<PoseSource*, 2> kSources = {&PoseByMotionModel, &PoseByReferenceKeyframe};
  after.motion = CameraMotion{Rigid3(), frame->timestamp - after.frame->timestamp};
  if (later != nullptr) {
    after.motion = CameraMotion{after.cam_from_world * Inverse(later->last.cam_from_world),
                                after.frame->timestamp - later->last.frame->timestamp};
  }
  std::optional<ConfirmedPose> found =
      FindConfirmedPose(*frame, map, context, after, kSources).found;
  return found ? std::optional(MakeFound(map, frame, std::move(found->tracking))) : std::nullopt;
}

// Whether the frame finds less than half of the landmarks of its reference keyframe. In a video all
// frames that are lost near a keyframe find more, and need only a pose.
bool ShowsNewPart(const Map& map, const LocalTracking& tracking) {
  const std::vector<LandmarkId>& landmarks = map.keyframes().At(tracking.reference).landmarks;
  return 2 * static_cast<size_t>(tracking.estimate.inliers) < IndicesOfValid(landmarks).size();
}

}  // namespace

void EarlyFrames::Keep(std::shared_ptr<const Frame> frame, bool is_tracked) {
  if (frames_.size() == kMostFrames) {
    const auto tracked = std::find_if(frames_.begin(), frames_.end(),
                                      [](const Kept& kept) { return kept.is_tracked; });
    frames_.erase(tracked != frames_.end() ? tracked : frames_.begin());
  }
  frames_.push_back({.frame = std::move(frame), .is_tracked = is_tracked});
}

std::optional<KeyframeRequest> EarlyFrames::FindKeyframe(const Map& map,
                                                         const TrackingContext& context) {
  for (Kept& kept : frames_) {
    if (kept.is_tracked || map.KeyframeOfFrame(kept.frame->id)) {
      continue;
    }
    std::vector<KeyframeId> keyframes = KeyframesForWideMatches(map, *kept.frame);
    if (keyframes == kept.compared) {
      continue;
    }
    kept.compared = std::move(keyframes);
    std::optional<ConfirmedPose> found =
        FindConfirmedPose(*kept.frame, map, context, LastFrame(), kWideSources).found;
    if (found && ShowsNewPart(map, found->tracking)) {
      return KeyframeRequest{.frame = kept.frame,
                             .pose = map.RelativeTo(found->tracking.reference,
                                                    found->tracking.estimate.cam_from_world),
                             .landmarks = std::move(found->tracking.estimate.landmarks),
                             .sightings = {},
                             .oldest_revision = 0};
    }
  }
  return std::nullopt;
}

std::vector<TrackedFrame> EarlyFrames::Localise(const Map& map, const TrackingContext& context,
                                                const Cancellation* cancellation,
                                                const ProgressCallback& on_progress) {
  std::vector<std::optional<FoundFrame>> found(frames_.size());
  LastFrame before;  // the last frame before the current one that was found
  for (size_t i = 0; i < frames_.size() && !IsRequested(cancellation); ++i) {
    const std::shared_ptr<const Frame>& frame = frames_[i].frame;
    found[i] = PoseOfKeyframe(map, frame);
    if (!found[i]) {
      found[i] = FindFrame(map, context, frame, before);
    }
    if (found[i]) {
      before = found[i]->last;
    }
    if (on_progress) {
      on_progress(static_cast<int>(i) + 1, static_cast<int>(frames_.size()));
    }
  }
  const auto after = [&](size_t i) {  // the frame right after this one, if it was found
    const bool is_next =
        i + 1 < frames_.size() && frames_[i + 1].frame->id.value == frames_[i].frame->id.value + 1;
    return is_next && found[i + 1] ? &*found[i + 1] : nullptr;
  };
  for (size_t i = frames_.size(); i-- > 0 && !IsRequested(cancellation);) {
    if (const FoundFrame* const next = after(i); next != nullptr && !found[i]) {
      found[i] = TrackBack(map, context, frames_[i].frame, next->last, after(i + 1));
    }
  }
  frames_.clear();
  std::vector<TrackedFrame> localised;
  for (std::optional<FoundFrame>& frame : found) {
    if (frame) {
      localised.push_back(std::move(frame->tracked));
    }
  }
  return localised;
}

}  // namespace hullslam
