// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hullslam {
namespace {

size_t CountCloseKeypoints(const Frame& frame, const Sensor& sensor,
                           const std::vector<LandmarkId>& landmarks, bool tracked) {
  size_t count = 0;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const double depth = static_cast<double>(frame.features.depth[i]);
    const bool is_close = depth > 0.0 && depth < sensor.close_depth;
    count += is_close && landmarks[i].IsValid() == tracked ? 1 : 0;
  }
  return count;
}

// Puts the landmarks of now in place of those replaced. Where two have become one the first
// keypoint keeps it: a frame observes a landmark once.
void ResolveAll(const Map& map, std::vector<LandmarkId>& landmarks) {
  std::vector<bool> is_taken(map.landmarks().NextId().value, false);
  for (LandmarkId& landmark : landmarks) {
    landmark = map.Resolve(landmark);
    if (!landmark.IsValid()) {
      continue;
    }
    if (is_taken[landmark.value]) {
      landmark = LandmarkId();
    } else {
      is_taken[landmark.value] = true;
    }
  }
}

}  // namespace

Tracker::Tracker(const Sensor& sensor, const TrackingOptions& options, const ObjectOptions& objects)
    : sensor_(sensor), options_(options), object_options_(objects) {
  policy_.min_reference_ratio = options.keyframe_ratio;
  policy_.min_frames_between =
      static_cast<uint32_t>(std::lround(options.keyframe_interval * sensor.frames_per_second));
  policy_.frames_for_objects = static_cast<uint32_t>(std::max(1.0, sensor.frames_per_second / 3.0));
  policy_.max_frames_between = static_cast<uint32_t>(std::max(1.0, sensor.frames_per_second));
}

Tracker::Result Tracker::Process(std::shared_ptr<const Frame> frame, std::shared_ptr<const Map> map,
                                 const MapperStatus& mapper) {
  const ScopedTimer timer(times_, "pose");
  frame_ = std::move(frame);
  map_ = std::move(map);
  if (map_ == nullptr || map_->keyframes().empty()) {
    return Initialize();
  }
  FollowMap();
  std::optional<Estimate> estimate = TrackWithMotionModel();
  if (!estimate) {
    estimate = TrackReferenceKeyframe();
  }
  if (estimate) {
    estimate = TrackLocalMap(std::move(*estimate));
  }
  if (!estimate) {
    return {Lose(), std::nullopt};
  }
  Result result;
  if (NeedsKeyframe(*estimate, mapper)) {
    result.request = MakeRequest(*estimate);
  }
  result.frame = Remember(*estimate);
  return result;
}

Tracker::Result Tracker::Initialize() {
  Result result;
  result.frame.frame = frame_->id;
  result.frame.timestamp = frame_->timestamp;
  const auto with_depth = std::count_if(
      frame_->features.depth.begin(), frame_->features.depth.end(), [](float z) { return z > 0; });
  if (with_depth < options_.min_initial_points) {
    return result;
  }
  KeyframeRequest request;
  request.frame = frame_;
  request.landmarks.resize(frame_->features.size());
  result.request = std::move(request);
  result.frame.state = TrackingState::kTracked;
  result.frame.reference = KeyframeId(0);
  result.frame.inliers = static_cast<int>(with_depth);
  last_ = {frame_, std::vector<LandmarkId>(frame_->features.size()), KeyframeId(0), Rigid3()};
  last_keyframe_ = frame_->id;
  reference_ = KeyframeId(0);
  velocity_.reset();
  return result;
}

// Brings what is remembered of the last frame up to date with the map of now.
void Tracker::FollowMap() {
  reference_ = map_->NearestAlive(reference_);
  if (const std::optional<KeyframeId> keyframe = map_->KeyframeOfFrame(last_.frame->id);
      keyframe && map_->keyframes().Contains(*keyframe)) {
    last_.landmarks = map_->keyframes().At(*keyframe).landmarks;
    last_.reference = *keyframe;
    last_.cam_from_reference = Rigid3();
    reference_ = *keyframe;
  }
  ResolveAll(*map_, last_.landmarks);
  last_from_world_ = last_.cam_from_reference * map_->CamFromWorld(last_.reference);
}

bool Tracker::NeedsKeyframe(const Estimate& estimate, const MapperStatus& mapper) const {
  KeyframeEvidence evidence;
  evidence.frames_since_keyframe = frame_->id.value - last_keyframe_.value;
  evidence.inliers = estimate.inliers;
  evidence.unknown_objects = estimate.unknown_objects;
  evidence.keyframes = map_->keyframes().size();
  evidence.mapper_is_idle = mapper.is_idle;
  evidence.requests_waiting = mapper.requests_waiting;
  const int min_support = evidence.keyframes <= 2 ? 2 : 3;
  for (const LandmarkId id : map_->keyframes().At(reference_).landmarks) {
    if (id.IsValid() && map_->landmarks().At(id).support >= min_support) {
      ++evidence.reference_landmarks;
    }
  }
  evidence.close_tracked =
      static_cast<int>(CountCloseKeypoints(*frame_, sensor_, estimate.landmarks, true));
  evidence.close_untracked =
      static_cast<int>(CountCloseKeypoints(*frame_, sensor_, estimate.landmarks, false));
  return policy_.NeedsKeyframe(evidence);
}

KeyframeRequest Tracker::MakeRequest(const Estimate& estimate) {
  KeyframeRequest request;
  request.frame = frame_;
  request.reference = reference_;
  request.cam_from_reference = estimate.cam_from_world * Inverse(map_->CamFromWorld(reference_));
  request.landmarks = estimate.landmarks;
  request.sightings = sightings_.Take();
  last_keyframe_ = frame_->id;
  return request;
}

TrackedFrame Tracker::Remember(const Estimate& estimate) {
  const Rigid3 cam_from_reference =
      estimate.cam_from_world * Inverse(map_->CamFromWorld(reference_));
  // After lost frames the motion since the last tracked one is not that of a single step.
  const bool is_next = frame_->id.value == last_.frame->id.value + 1;
  velocity_ =
      is_next ? std::optional(estimate.cam_from_world * Inverse(last_from_world_)) : std::nullopt;
  last_ = {frame_, estimate.landmarks, reference_, cam_from_reference};
  return {.frame = frame_->id,
          .timestamp = frame_->timestamp,
          .state = TrackingState::kTracked,
          .reference = reference_,
          .cam_from_reference = cam_from_reference,
          .cam_from_world = estimate.cam_from_world,
          .inliers = estimate.inliers};
}

TrackedFrame Tracker::Lose() {
  velocity_.reset();
  TrackedFrame lost;
  lost.frame = frame_->id;
  lost.timestamp = frame_->timestamp;
  lost.state = TrackingState::kLost;
  return lost;
}

}  // namespace hullslam
