// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "frame/measure_point.h"
#include "map/islands.h"
#include "tracking/keyframe_evidence.h"

namespace hullslam {
namespace {

constexpr size_t kYoungKeyframes = 10;  // an island with fewer keyframes is young
// So long a camera stays without a pose before a new island may begin: a time (s), and a number of
// frames, because with few images per second a single lost frame says little.
constexpr double kPatience = 1.0;
constexpr int kPatientFrames = 3;
constexpr int kMostCredit = 10;  // frames; see Tracker::prior_credit_

KeyframePolicy MakePolicy(const Sensor& sensor, const TrackingOptions& options) {
  KeyframePolicy policy;
  policy.rule = options.keyframe_rule;
  policy.has_depth = !sensor.IsMonocular();
  policy.min_reference_ratio = options.keyframe_ratio;
  policy.min_landmarks = options.min_inliers / 2;
  policy.min_confirmed = sensor.IsMonocular() ? options.min_inliers : 0;
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

// See TrackedFrame::quality; px.
double QualityOf(double corner_sigma) {
  return corner_sigma > 0.0 ? 1.0 - std::exp(-0.5 / (corner_sigma * corner_sigma)) : 0.0;
}

// Why this frame was not found, although there is a map. `last` is the frame before.
TrackingFailure WhyLost(const Frame& frame, const TrackingContext& context, const LastFrame& last,
                        const PoseSearch& search) {
  if (frame.features.size() < static_cast<size_t>(context.min_relocalisation_inliers())) {
    return TrackingFailure::kTooFewFeatures;
  }
  if (last.motion && !PredictMotion(last, frame.timestamp)) {
    return TrackingFailure::kImagesMissing;
  }
  return search.most_unconfirmed >= context.options.min_inliers / 2
             ? TrackingFailure::kTooFewLandmarks
             : TrackingFailure::kNotRecognised;
}

}  // namespace

std::vector<Sighting> SightingCounter::Take() {
  std::vector<Sighting> sightings;
  for (const auto& [landmark, counts] : counts_.Take()) {
    sightings.push_back({landmark, counts.visible, counts.found});
  }
  std::sort(sightings.begin(), sightings.end(),
            [](const Sighting& a, const Sighting& b) { return a.landmark < b.landmark; });
  return sightings;
}

Tracker::Tracker(const Sensor& sensor, const TrackingOptions& options, const ObjectOptions& objects,
                 uint64_t seed)
    : sensor_(sensor),
      wide_sensor_(WithWideErrors(sensor)),
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
  first_frame_ = first_frame_.IsValid() ? first_frame_ : frame->id;
  Result result = has_map ? Track(std::move(frame), *map, mapper) : Initialize(std::move(frame));
  result.report.map_revision = has_map ? map->revision() : 0;
  result.report.tracked.odometry =
      odometry_.Add(result.report.tracked, last_, result.report.frame->motion,
                    has_map ? map->correction_count() : 0);
  return result;
}

Tracker::Result Tracker::Initialize(std::shared_ptr<const Frame> frame) {
  MonocularInitialiser::Result initial = FindInitialMap(frame);
  if (initial.map && start_) {
    for (InitialMap::View& view : initial.map->views) {
      view.cam_from_world = view.cam_from_world * Inverse(*start_);
    }
    for (InitialMap::Point& point : initial.map->points) {
      point.position = *start_ * point.position;
    }
  }
  if (initial.map) {
    return BeginIsland(std::move(frame), std::move(*initial.map));
  }
  KeepEarly(frame, false);
  Result result = MakeResult(std::move(frame), TrackingState::kNotInitialized);
  if (island_rules_.needs_motion) {
    result.report.failure = initial.failure;
  }
  return result;
}

// The map that begins with this frame, without depth also with earlier ones.
MonocularInitialiser::Result Tracker::FindInitialMap(const std::shared_ptr<const Frame>& frame) {
  if (island_rules_.needs_motion) {
    return initialiser_.Process(frame);
  }
  const std::vector<uint32_t> with_depth = KeypointsByDepth(frame->features);
  if (with_depth.size() < static_cast<size_t>(options_.min_initial_points)) {
    return {.map = std::nullopt, .failure = InitialisationFailure::kTooFewFeatures};
  }
  return {.map = MakeInitialMap(frame, sensor_.camera, with_depth), .failure = {}};
}

void Tracker::KeepEarly(const std::shared_ptr<const Frame>& frame, bool is_tracked) {
  if (options_.locate_at_end) {
    early_.Keep(frame, is_tracked);
  }
}

// The frame is the last view of the initial map.
Tracker::Result Tracker::BeginIsland(std::shared_ptr<const Frame> frame, InitialMap initial) {
  lost_since_.reset();
  lost_frames_ = 0;
  last_ = LastFrame();
  last_.frame = frame;
  last_request_time_ = frame->timestamp;
  Result result = MakeResult(std::move(frame), TrackingState::kTracked);
  result.report.tracked.inliers = static_cast<int>(initial.points.size());
  result.report.tracked.cam_from_world = initial.views.back().cam_from_world;
  result.message = std::move(initial);
  return result;
}

std::vector<TrackedFrame> Tracker::LocaliseEarlyFrames(const Map& map,
                                                       const Cancellation* cancellation,
                                                       const ProgressCallback& on_progress) {
  // If no frame has a pose, the map is that of an earlier session, which was not found.
  if (last_.frame == nullptr || !options_.locate_at_end) {
    return {};
  }
  object_index_.Follow(map, sensor_.camera);
  return early_.Localise(map, Context(), cancellation, on_progress);
}

std::optional<KeyframeRequest> Tracker::FindLostKeyframe(const Map& map) {
  if (!HasHadWideSteps()) {
    return std::nullopt;
  }
  object_index_.Follow(map, sensor_.camera);
  is_wide_ = true;
  return early_.FindKeyframe(map, Context());
}

Tracker::Result Tracker::Track(std::shared_ptr<const Frame> frame, const Map& map,
                               const MapperStatus& mapper) {
  if (last_.frame != nullptr) {
    last_ = FollowMap(map, std::move(last_));
  }
  if (!frame->detections.empty()) {
    object_index_.Follow(map, sensor_.camera);
  }
  last_.ahead = MotionAhead(last_, *frame);
  PoseSearch search;
  std::optional<Found> found = FindPose(frame, map, search);
  if (!found && last_.ahead) {
    if (std::optional<Result> reckoned = DeadReckon(frame, map, mapper)) {
      return std::move(*reckoned);
    }
  }
  if (!found) {
    const TrackingFailure reason = WhyLost(*frame, Context(), last_, search);
    return Lose(std::move(frame), map, reason);
  }
  return Accept(std::move(*found), frame, map, mapper);
}

std::optional<Tracker::Found> Tracker::FindWithoutPrior(const std::shared_ptr<const Frame>& frame,
                                                        const Map& map, PoseSearch& search) const {
  std::optional<Found> found = FindCorrectedPose(frame, map, search);
  // A new session is found in its map by words or objects only.
  if (!found && MayMatchWidely() && last_.frame != nullptr) {
    found = FindWidely(frame, map, search);
  }
  return found;
}

// With a motion prior, which is left out if it finds no pose or not the one of the landmarks.
std::optional<Tracker::Found> Tracker::FindPose(const std::shared_ptr<const Frame>& frame,
                                                const Map& map, PoseSearch& search) {
  std::optional<Found> found = FindWithoutPrior(frame, map, search);
  if (!last_.ahead || FuseAhead(*last_.ahead, *frame, map, found)) {
    return found;
  }
  const std::optional<MotionPrior> ahead = std::exchange(last_.ahead, std::nullopt);
  found = FindWithoutPrior(frame, map, search);
  FuseAhead(*ahead, *frame, map, found);
  last_.ahead = ahead;
  return found;
}

// Fuses a pose with the one that the motion `ahead` from the last frame leads to. Returns false if
// they contradict each other or are in different islands.
bool Tracker::FuseAhead(const MotionPrior& ahead, const Frame& frame, const Map& map,
                        std::optional<Found>& found) const {
  if (!found || IslandOf(map, found->tracking.reference) != IslandOf(map, last_.reference)) {
    return false;
  }
  PoseEstimate& estimate = found->tracking.estimate;
  estimate.last_covariance = InAxesOf(ahead.cam_from_last_cam, last_.shared_covariance);
  estimate.motion_covariance = ahead.covariance;
  const bool is_fused = FusePrior(
      ahead.cam_from_last_cam * last_.cam_from_world,
      InAxesOf(ahead.cam_from_last_cam, last_.measured_covariance) + ahead.covariance, estimate);
  found->prior = is_fused ? PriorUse::kFused : PriorUse::kDropped;
  if (found->motion) {
    found->motion = MotionSince(last_, frame, estimate.cam_from_world);
  }
  return is_fused;
}

// The result of a frame that shows too few landmarks, by the priors since the last one that did.
// Null if the pose has become too uncertain to tell what the image may show. If images are good but
// of an unknown place, the frame becomes a keyframe, which only the priors tie to the others.
std::optional<Tracker::Result> Tracker::DeadReckon(const std::shared_ptr<const Frame>& frame,
                                                   const Map& map, const MapperStatus& mapper) {
  constexpr double kMostOfWidth = 0.25;  // standard deviation of a pixel over the image's width
  if (prior_credit_ < 0) {
    return std::nullopt;  // landmarks have contradicted most of the last priors
  }
  const MotionPrior& ahead = *last_.ahead;
  const auto covariance_after = [&](const Eigen::Matrix<double, 6, 6>& covariance) {
    return (InAxesOf(ahead.cam_from_last_cam, covariance) + ahead.covariance).eval();
  };
  const double sigma = CornerSigma(
      sensor_.camera, covariance_after(last_.measured_covariance).inverse(), last_.median_depth);
  if (last_.median_depth == 0.0 || !(sigma <= kMostOfWidth * sensor_.camera.width)) {
    return std::nullopt;
  }
  last_.motion.reset();
  last_.velocity.reset();
  lost_since_.reset();
  const bool is_rich =
      KeypointsByDepth(frame->features).size() >= static_cast<size_t>(options_.min_initial_points);
  lost_frames_ = is_rich ? lost_frames_ + 1 : 0;
  Result result = MakeResult(frame, TrackingState::kTracked);
  TrackedFrame& tracked = result.report.tracked;
  tracked.cam_from_world = ahead.cam_from_last_cam * last_.cam_from_world;
  tracked.from_keyframe = map.RelativeTo(last_.reference, tracked.cam_from_world);
  tracked.covariance = covariance_after(last_.covariance);
  tracked.quality = QualityOf(sigma);
  tracked.prior = PriorUse::kAlone;
  if (lost_frames_ >= kPatientFrames && mapper.is_idle && !is_localizing_only_) {
    LocalTracking nothing;
    nothing.estimate.landmarks = result.report.landmarks;
    result.message = MakeRequest(frame, nothing, *tracked.from_keyframe);
    drift_.Add(frame->id, tracked.cam_from_world, *tracked.covariance);
    lost_frames_ = 0;
    last_.frame = frame;
    last_.landmarks = result.report.landmarks;
    last_.pose = tracked.from_keyframe;
    last_.cam_from_world = tracked.cam_from_world;
    last_.followed_change = 1.0;
    last_.measured_covariance = last_.shared_covariance = Eigen::Matrix<double, 6, 6>::Zero();
    last_.covariance = *tracked.covariance;
  }
  return result;
}

// The result of a frame that was found. `as_read` is the frame before it was corrected.
Tracker::Result Tracker::Accept(Found found, const std::shared_ptr<const Frame>& as_read,
                                const Map& map, const MapperStatus& mapper) {
  if (island_rules_.needs_motion && !is_localizing_only_ && IsYoung(map)) {
    KeepEarly(as_read, true);
  }
  lost_since_.reset();
  lost_frames_ = 0;
  if (found.is_relocalised) {
    relocalised_at_ = as_read->timestamp;
  }
  prior_credit_ += found.prior == PriorUse::kFused ? 1 : 0;
  prior_credit_ -= found.prior == PriorUse::kDropped ? 1 : 0;
  prior_credit_ = std::clamp(prior_credit_, -kMostCredit, kMostCredit);
  initialiser_.Forget();
  std::shared_ptr<const Frame> frame = std::move(found.corrected.frame);
  const LocalTracking& tracking = found.tracking;
  if (!is_localizing_only_) {
    CountSightings(map, tracking);
  }
  const PoseEstimate& estimate = tracking.estimate;
  const RelativePose pose = map.RelativeTo(tracking.reference, estimate.cam_from_world);
  const Eigen::Matrix<double, 6, 6> measured = drift_.Measured(estimate);
  const Eigen::Matrix<double, 6, 6> covariance = measured + drift_.Drift(map, estimate);

  Result result;
  if (!is_localizing_only_ && (NeedsKeyframe(*frame, map, tracking, mapper) || found.is_wide)) {
    result.message = MakeRequest(frame, tracking, pose);
    drift_.Add(frame->id, estimate.cam_from_world, covariance);
  }
  has_had_wide_steps_ |= found.is_wide;
  is_wide_ = found.is_wide || (is_wide_ && result.message);
  result.report = {.tracked = {.frame = frame->id,
                               .timestamp = frame->timestamp,
                               .state = TrackingState::kTracked,
                               .from_keyframe = pose,
                               .cam_from_world = estimate.cam_from_world,
                               .inliers = estimate.inliers,
                               .is_unsure = CountConfirmed(map, tracking.reference, estimate) <
                                            policy_.min_confirmed,
                               .covariance = covariance,
                               .quality = QualityOf(estimate.corner_sigma),
                               .prior = found.prior},
                   .frame = frame,
                   .landmarks = estimate.landmarks,
                   .objects = tracking.objects};
  last_ = {.frame = std::move(frame),
           .landmarks = estimate.landmarks,
           .pose = pose,
           .reference = tracking.reference,
           .cam_from_world = estimate.cam_from_world,
           .motion = found.motion,
           .velocity = found.corrected.velocity,
           .map_per_odometry = last_.map_per_odometry,
           .measured_covariance = estimate.information.inverse(),
           .shared_covariance = measured,
           .covariance = covariance,
           .median_depth = estimate.median_depth};
  return result;
}

// Finds the pose with the frame that the last velocity predicts. If this fails, the velocity may be
// wrong, so the frame as read is tried too. `search` is the last search.
std::optional<Tracker::Found> Tracker::FindCorrectedPose(
    const std::shared_ptr<const Frame>& as_read, const Map& map, PoseSearch& search) const {
  const std::shared_ptr<const Frame> predicted = PredictGlobalShutter(as_read, map, sensor_, last_);
  if (predicted != as_read) {
    if (std::optional<Found> found = FindCorrectedPose(as_read, predicted, map, search)) {
      return found;
    }
  }
  return FindCorrectedPose(as_read, as_read, map, search);
}

// `tried` is the frame as read or the predicted one.
std::optional<Tracker::Found> Tracker::FindCorrectedPose(
    const std::shared_ptr<const Frame>& as_read, const std::shared_ptr<const Frame>& tried,
    const Map& map, PoseSearch& search) const {
  // Between images that are far apart, a constant velocity predicts nothing.
  const std::span<PoseSource* const> sources =
      std::span(kPoseSources).subspan(is_wide_ && !last_.ahead ? 1 : 0);
  search = FindConfirmedPose(*tried, map, Context(), last_, sources);
  if (!search.found) {
    return std::nullopt;
  }
  // A frame that is found anew has nothing to do with the last velocity.
  const bool continues = BeginsAtLastFrame(sources[search.found->source]);
  if (!continues && tried != as_read) {
    return std::nullopt;
  }
  const LastFrame no_last_frame;
  const LastFrame& last = continues ? last_ : no_last_frame;
  Found found;
  found.tracking = std::move(search.found->tracking);
  found.corrected = CorrectShutter(as_read, tried, map, Context(), last, found.tracking);
  found.is_relocalised = !continues;
  found.motion = MotionSince(last, *as_read, found.tracking.estimate.cam_from_world);
  return found;
}

// Finds the pose of a frame that is far from all that is known of the camera's path. Its landmarks
// are seen from elsewhere, so errors of their depths show in the image.
std::optional<Tracker::Found> Tracker::FindWidely(const std::shared_ptr<const Frame>& as_read,
                                                  const Map& map, PoseSearch& search) const {
  PoseSearch found_widely = FindConfirmedPose(*as_read, map, WideContext(), last_, kWideSources);
  search.most_unconfirmed = std::max(search.most_unconfirmed, found_widely.most_unconfirmed);
  if (!found_widely.found) {
    return std::nullopt;
  }
  Found found;
  found.tracking = std::move(found_widely.found->tracking);
  found.corrected.frame = as_read;
  found.is_relocalised = true;
  found.is_wide = true;
  return found;
}

bool Tracker::NeedsKeyframe(const Frame& frame, const Map& map, const LocalTracking& tracking,
                            const MapperStatus& mapper) {
  last_request_time_ = last_request_time_.value_or(frame.timestamp);
  const int lasting_changes = lasting_changes_.Follow(frame, map, Context(), tracking);
  KeyframeEvidence evidence = GatherEvidence(frame, map, sensor_, tracking, last_);
  evidence.time_since_keyframe = frame.timestamp - *last_request_time_;
  evidence.mapper_is_idle = mapper.is_idle;
  evidence.requests_waiting = mapper.requests_waiting;
  evidence.has_islands =
      Islands(map).size() > 1 &&
      join_requests_.MayAskAgain(map, sensor_, tracking.reference, tracking.estimate);
  evidence.fruitless_requests = object_requests_.CountFruitless(map);
  if (relocalised_at_) {
    evidence.time_since_relocalisation = frame.timestamp - *relocalised_at_;
  }
  if (!policy_.NeedsKeyframe(evidence) && lasting_changes == 0) {
    return false;
  }
  evidence.is_known_view =
      IsKnownView(map, sensor_, frame, first_frame_, tracking.reference, tracking.estimate);
  evidence.is_well_mapped =
      lasting_changes_.IsBeingLearnt() || IsWellMapped(map, sensor_, frame, first_frame_, tracking);
  if (evidence.is_well_mapped && options_.keyframes_for_objects) {
    evidence.unknown_objects = lasting_changes;
    evidence.fruitless_requests = 0;
  }
  if (!policy_.NeedsKeyframe(evidence)) {
    return false;
  }
  if (evidence.is_well_mapped) {
    lasting_changes_.NoteRequest();
  } else if (policy_.NeedsKeyframeForObjects(evidence)) {
    object_requests_.AddRequest();
  }
  if (policy_.NeedsKeyframeForJoin(evidence)) {
    join_requests_.Add(map, tracking.reference, tracking.estimate);
  }
  return true;
}

// Whether the island in which the camera was last seen has few keyframes.
bool Tracker::IsYoung(const Map& map) const {
  const IslandId island = last_.frame != nullptr ? IslandOf(map, last_.reference) : MainIsland(map);
  return map.IslandSize(island) < kYoungKeyframes;
}

// Whether the island is so small that ORB-SLAM2 would begin its map again.
bool Tracker::IsTiny(const Map& map) const {
  constexpr size_t kMostKeyframes = 5;
  return last_.frame != nullptr && map.IslandSize(IslandOf(map, last_.reference)) <= kMostKeyframes;
}

// A camera that stays lost begins a new island, which may be joined to the others later.
Tracker::Result Tracker::Lose(std::shared_ptr<const Frame> frame, const Map& map,
                              TrackingFailure reason) {
  last_.motion.reset();
  last_.velocity.reset();
  last_.ahead.reset();
  lost_since_ = lost_since_.value_or(frame->timestamp);
  ++lost_frames_;
  if (!is_localizing_only_) {
    KeepEarly(frame, false);
  }
  if (MayBeginIsland(*frame, map)) {
    MonocularInitialiser::Result initial = FindInitialMap(frame);
    if (initial.map) {
      has_had_wide_steps_ = true;
      return BeginIsland(std::move(frame), std::move(*initial.map));
    }
  }
  Result result = MakeResult(std::move(frame), TrackingState::kLost);
  result.report.loss = reason;
  return result;
}

// In an island that is not young, the camera may soon be found again, and only place recognition,
// which needs words, can join a new island to it. In a young island there is little to be found.
// The map of an earlier session is not given up like this before the camera was found in it.
bool Tracker::MayBeginIsland(const Frame& frame, const Map& map) const {
  if (is_localizing_only_ || (!options_.begin_islands && !IsTiny(map))) {
    return false;
  }
  const bool has_waited =
      frame.timestamp - *lost_since_ >= kPatience && lost_frames_ >= kPatientFrames;
  const bool was_found = last_.frame != nullptr;
  return was_found && IsYoung(map) ? has_waited || island_rules_.begins_at_once
                                   : has_waited && map.vocabulary() != nullptr;
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
          .oldest_revision = std::min(
              kept_revision_, std::exchange(first_sighting_revision_, std::nullopt).value_or(0))};
}

}  // namespace hullslam
