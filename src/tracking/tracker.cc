// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/tracker.h"

#include <utility>

#include "map/islands.h"
#include "tracking/confirmed_pose.h"
#include "tracking/shutter_correction.h"

namespace hullslam {
namespace {

constexpr size_t kYoungKeyframes = 10;  // a monocular island with fewer keyframes is young
constexpr double kPatience = 1.0;       // s without a pose, before a new island may begin

KeyframePolicy MakePolicy(const Sensor& sensor, const TrackingOptions& options) {
  KeyframePolicy policy;
  policy.min_reference_ratio = options.keyframe_ratio;
  policy.min_landmarks = options.min_inliers / 2;
  policy.min_time_between = options.keyframe_interval;
  policy.time_tolerance = 0.5 / sensor.frames_per_second;
  return policy;
}

// The initial map of an RGB-D camera: one frame, whose camera frame is the world frame, and a point
// for each of its keypoints with depth.
InitialMap MakeInitialMap(std::shared_ptr<const Frame> frame, const PinholeCamera& camera,
                          const std::vector<uint32_t>& keypoints) {
  InitialMap initial;
  for (const uint32_t keypoint : keypoints) {
    const Eigen::Vector2d pixel = frame->features.keypoints[keypoint].undistorted.cast<double>();
    const double depth = static_cast<double>(frame->features.depth[keypoint]);
    initial.points.push_back({.position = camera.Unproject(pixel, depth),
                              .observations = {{.view = 0, .keypoint = keypoint}}});
  }
  initial.views.push_back({.frame = std::move(frame), .cam_from_world = Rigid3()});
  return initial;
}

int CountCloseKeypoints(const Frame& frame, const Sensor& sensor,
                        const std::vector<LandmarkId>& landmarks, bool tracked) {
  int count = 0;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const double depth = static_cast<double>(frame.features.depth[i]);
    const bool is_close = depth > 0.0 && depth < sensor.close_depth;
    count += is_close && landmarks[i].IsValid() == tracked ? 1 : 0;
  }
  return count;
}

// The number of the reference keyframe's landmarks with a sufficient observation weight.
int CountReferenceLandmarks(const Map& map, KeyframeId reference) {
  const int min_weight = map.IslandSize(IslandOf(map, reference)) <= 2 ? 2 : 3;
  int count = 0;
  for (const LandmarkId id : map.keyframes().At(reference).landmarks) {
    count += id.IsValid() && map.landmarks().At(id).observation_weight >= min_weight ? 1 : 0;
  }
  return count;
}

KeyframeEvidence GatherEvidence(const Frame& frame, const Map& map, const Sensor& sensor,
                                const LocalTracking& tracking, double last_request_time,
                                const MapperStatus& mapper) {
  const PoseEstimate& estimate = tracking.estimate;
  return {.time_since_keyframe = frame.timestamp - last_request_time,
          .inliers = estimate.inliers,
          .reference_landmarks = CountReferenceLandmarks(map, tracking.reference),
          .close_tracked = CountCloseKeypoints(frame, sensor, estimate.landmarks, true),
          .close_untracked = CountCloseKeypoints(frame, sensor, estimate.landmarks, false),
          .unknown_objects = tracking.unknown_objects,
          .keyframes = map.IslandSize(IslandOf(map, tracking.reference)),
          .mapper_is_idle = mapper.is_idle,
          .requests_waiting = mapper.requests_waiting};
}

// The result for a frame without a pose or for a frame of the initial map.
Tracker::Result MakeResult(std::shared_ptr<const Frame> frame, TrackingState state) {
  Tracker::Result result;
  result.report.tracked.frame = frame->id;
  result.report.tracked.timestamp = frame->timestamp;
  result.report.tracked.state = state;
  result.report.landmarks.resize(frame->features.size());
  result.report.objects.resize(frame->detections.size());
  result.report.frame = std::move(frame);
  return result;
}

}  // namespace

Tracker::Tracker(const Sensor& sensor, const TrackingOptions& options, const ObjectOptions& objects,
                 uint64_t seed)
    : sensor_(sensor),
      island_rules_(IslandRules::ForSensor(sensor.kind)),
      options_(options),
      object_options_(objects),
      seed_(seed),
      policy_(MakePolicy(sensor, options)),
      initialiser_(sensor, seed) {}

Tracker::Result Tracker::Process(std::shared_ptr<const Frame> frame, std::shared_ptr<const Map> map,
                                 const MapperStatus& mapper) {
  const ScopedTimer timer(times_, "pose");
  const bool has_map = map != nullptr && !map->keyframes().empty();
  if (!has_map) {
    return island_rules_.needs_motion ? InitializeMonocular(std::move(frame))
                                      : Initialize(std::move(frame));
  }
  return Track(std::move(frame), *map, mapper);
}

Tracker::Result Tracker::Initialize(std::shared_ptr<const Frame> frame) {
  const std::vector<uint32_t> with_depth = KeypointsByDepth(frame->features);
  if (with_depth.size() < static_cast<size_t>(options_.min_initial_points)) {
    return MakeResult(std::move(frame), TrackingState::kNotInitialized);
  }
  InitialMap initial = MakeInitialMap(frame, sensor_.camera, with_depth);
  return BeginIsland(std::move(frame), std::move(initial));
}

Tracker::Result Tracker::InitializeMonocular(std::shared_ptr<const Frame> frame) {
  MonocularInitialiser::Result initial = initialiser_.Process(frame);
  if (initial.map) {
    return BeginIsland(std::move(frame), std::move(*initial.map));
  }
  early_.Keep(frame, false);
  Result result = MakeResult(std::move(frame), TrackingState::kNotInitialized);
  result.report.failure = initial.failure;
  return result;
}

// The frame is the last view of the initial map.
Tracker::Result Tracker::BeginIsland(std::shared_ptr<const Frame> frame, InitialMap initial) {
  lost_since_.reset();
  last_ = LastFrame();
  last_.frame = frame;
  last_request_time_ = frame->timestamp;
  Result result = MakeResult(std::move(frame), TrackingState::kTracked);
  result.report.tracked.inliers = static_cast<int>(initial.points.size());
  result.message = std::move(initial);
  return result;
}

std::vector<TrackedFrame> Tracker::LocaliseEarlyFrames(const Map& map,
                                                       const Cancellation* cancellation,
                                                       const ProgressCallback& on_progress) {
  object_index_.Follow(map, sensor_.camera);
  return early_.Localise(map, Context(), cancellation, on_progress);
}

Tracker::Result Tracker::Track(std::shared_ptr<const Frame> frame, const Map& map,
                               const MapperStatus& mapper) {
  if (last_.frame != nullptr) {
    last_ = FollowMap(map, std::move(last_));
  }
  if (!frame->detections.empty()) {
    object_index_.Follow(map, sensor_.camera);
  }
  const std::shared_ptr<const Frame> as_read = frame;
  frame = PredictGlobalShutter(as_read, map, sensor_, last_);
  std::optional<ConfirmedPose> found =
      FindConfirmedPose(*frame, map, Context(), last_, kPoseSources);
  if (!found) {
    return Lose(as_read, map);
  }
  if (island_rules_.needs_motion && !is_localizing_only_ && IsYoung(map)) {
    early_.Keep(as_read, true);
  }
  lost_since_.reset();
  initialiser_.Forget();
  LocalTracking& tracking = found->tracking;
  frame = CorrectShutter(as_read, map, Context(), last_, tracking);
  if (!is_localizing_only_) {
    CountSightings(map, tracking);
  }
  const PoseEstimate& estimate = tracking.estimate;
  const RelativePose pose = map.RelativeTo(tracking.reference, estimate.cam_from_world);

  Result result;
  if (!is_localizing_only_ && NeedsKeyframe(*frame, map, tracking, mapper)) {
    result.message = MakeRequest(frame, tracking, pose);
  }
  result.report = {.tracked = {.frame = frame->id,
                               .timestamp = frame->timestamp,
                               .state = TrackingState::kTracked,
                               .from_keyframe = pose,
                               .cam_from_world = estimate.cam_from_world,
                               .inliers = estimate.inliers},
                   .frame = frame,
                   .landmarks = estimate.landmarks,
                   .objects = tracking.objects};
  const std::optional<CameraMotion> motion = MotionSince(last_, *frame, estimate.cam_from_world);
  last_ = {.frame = std::move(frame),
           .landmarks = estimate.landmarks,
           .pose = pose,
           .reference = tracking.reference,
           .cam_from_world = estimate.cam_from_world,
           .motion = motion};
  return result;
}

bool Tracker::NeedsKeyframe(const Frame& frame, const Map& map, const LocalTracking& tracking,
                            const MapperStatus& mapper) {
  last_request_time_ = last_request_time_.value_or(frame.timestamp);
  KeyframeEvidence evidence =
      GatherEvidence(frame, map, sensor_, tracking, *last_request_time_, mapper);
  evidence.fruitless_requests = object_requests_.CountFruitless(map);
  if (!policy_.NeedsKeyframe(evidence)) {
    return false;
  }
  if (policy_.NeedsKeyframeForObjects(evidence)) {
    object_requests_.AddRequest();
  }
  return true;
}

// Whether the island in which the camera was last seen has few keyframes.
bool Tracker::IsYoung(const Map& map) const {
  const IslandId island = last_.frame != nullptr ? IslandOf(map, last_.reference) : MainIsland(map);
  return map.IslandSize(island) < kYoungKeyframes;
}

// A monocular camera that stays lost begins a new island, which may be joined to the others later.
Tracker::Result Tracker::Lose(std::shared_ptr<const Frame> frame, const Map& map) {
  last_.motion.reset();
  lost_since_ = lost_since_.value_or(frame->timestamp);
  if (MayBeginIsland(*frame, map)) {
    MonocularInitialiser::Result initial = initialiser_.Process(frame);
    early_.Keep(frame, false);
    if (initial.map) {
      return BeginIsland(std::move(frame), std::move(*initial.map));
    }
  }
  return MakeResult(std::move(frame), TrackingState::kLost);
}

// In an island that is not young, the camera may soon be found again, and only place recognition,
// which needs words, can join a new island to it. In a young island there is little to be found.
bool Tracker::MayBeginIsland(const Frame& frame, const Map& map) const {
  if (!island_rules_.begins_when_lost || is_localizing_only_) {
    return false;
  }
  const bool has_waited = frame.timestamp - *lost_since_ >= kPatience;
  return IsYoung(map) || (has_waited && map.vocabulary() != nullptr);
}

void Tracker::CountSightings(const Map& map, const LocalTracking& tracking) {
  first_sighting_revision_ = first_sighting_revision_.value_or(map.revision());
  for (const LandmarkId landmark : tracking.visible) {
    sightings_.CountVisible(landmark);
  }
  for (const LandmarkId landmark : tracking.estimate.landmarks) {
    if (landmark.IsValid()) {
      sightings_.CountFound(landmark);
    }
  }
}

KeyframeRequest Tracker::MakeRequest(std::shared_ptr<const Frame> frame,
                                     const LocalTracking& tracking, const RelativePose& pose) {
  last_request_time_ = frame->timestamp;
  return {.frame = std::move(frame),
          .pose = pose,
          .landmarks = tracking.estimate.landmarks,
          .sightings = sightings_.Take(),
          .oldest_revision = std::exchange(first_sighting_revision_, std::nullopt).value_or(0)};
}

}  // namespace hullslam
