// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/monocular_initialiser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "estimators/absolute_pose.h"
#include "estimators/two_views.h"
#include "frame/measure_point.h"
#include "map/initial_map.h"
#include "map/keyframe_graph.h"
#include "matching/by_descriptor.h"
#include "optim/bundle_adjustment.h"
#include "tracking/shutter_correction.h"
#include "tracking/sources/pair_votes.h"
#include "util/hash.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kMinFeatures = 100;
constexpr size_t kMinMatches = 80;
constexpr size_t kMostReferences = 12;
constexpr double kReferenceInterval = 0.1;  // s from one reference to the next
constexpr size_t kFramesBetween = 3;        // most frames between the first and the last view
constexpr double kMinConfirmed = 0.6;  // share of its matches that a frame in between must confirm
// If half of the keypoints have moved by less than this share of the image's width, the images have
// too little parallax. Only the map of a camera that moves forward may have more keypoints that
// hardly move (TwoViewOptions::forward_factor).
constexpr double kMinShift = 0.015;

using FramePointer = std::shared_ptr<const Frame>;

std::vector<Match> MatchFrames(const Frame& from, const Frame& to) {
  std::vector<uint32_t> all(from.features.size());
  std::iota(all.begin(), all.end(), 0U);
  return MatchByDescriptor(from.features, all, to.features, {});
}

// The distance in pixels by which this share of the keypoints has moved.
double TypicalShift(double share, const Frame& from, const Frame& to,
                    const std::vector<Match>& matches) {
  const auto position = [](const FrameFeatures& features, uint32_t keypoint) {
    return features.grid.PositionOf(features.keypoints, keypoint);
  };
  std::vector<float> shifts;
  for (const Match& match : matches) {
    shifts.push_back(
        (position(from.features, match.query) - position(to.features, match.keypoint)).norm());
  }
  return static_cast<double>(ReachedBy(share, std::move(shifts)));
}

InitialisationFailure ToInitialisationFailure(TwoViewFailure failure) {
  switch (failure) {
    case TwoViewFailure::kTooFewPairs:
      return InitialisationFailure::kTooFewMatches;
    case TwoViewFailure::kTooLittleParallax:
      return InitialisationFailure::kTooLittleParallax;
    case TwoViewFailure::kAmbiguous:
      return InitialisationFailure::kAmbiguous;
    default:
      return InitialisationFailure::kTooFewPoints;
  }
}

// The points of two views: the world frame is the camera frame of the first one.
InitialMap MakeMap(const FramePointer& first, const FramePointer& last,
                   const std::vector<Match>& matches, const TwoViews& motion) {
  InitialMap map;
  map.views = {{first, Rigid3()}, {last, motion.b_from_a}};
  for (const TwoViews::Point& point : motion.points) {
    const Match& match = matches[point.pair];
    map.points.push_back(
        {.position = point.point_in_a, .observations = {{0, match.query}, {1, match.keypoint}}});
  }
  return map;
}

// Adds a frame that was taken between the views of a map, in the order of time, if the map explains
// the frame. Returns false only if the map contradicts the frame; a frame that shows too little of
// the map is not added and does not count.
bool AddFrameBetween(const Sensor& sensor, uint64_t seed, const FramePointer& frame,
                     InitialMap& map) {
  const Frame& first = *map.views.front().frame;
  std::vector<uint32_t> keypoints;
  for (const InitialMap::Point& point : map.points) {
    keypoints.push_back(point.observations.front().keypoint);
  }
  std::vector<size_t> point_of(first.features.size());
  for (size_t i = 0; i < keypoints.size(); ++i) {
    point_of[keypoints[i]] = i;
  }
  const std::vector<Match> matches =
      MatchByDescriptor(first.features, keypoints, frame->features, {});
  if (matches.size() < kMinInitialPoints / 2) {
    return true;
  }
  std::vector<PoseObservation> observations;
  for (const Match& match : matches) {
    observations.push_back(
        {.point = map.points[point_of[match.query]].position,
         .measurement = MeasurePoint(sensor, frame->features, match.keypoint, sensor.depth_error)});
  }
  const AbsolutePose pose = EstimateAbsolutePose(
      sensor.camera, observations, {.seed = HashSeed(seed, frame->id.value, "initial map")});
  if (!pose.ok() || static_cast<double>(pose.inliers.size()) <
                        kMinConfirmed * static_cast<double>(matches.size())) {
    return false;
  }
  // The new view comes before the last one.
  const size_t inserted = map.views.size() - 1;
  for (InitialMap::Point& point : map.points) {
    for (InitialMap::Observation& seen : point.observations) {
      seen.view += seen.view == inserted ? 1 : 0;
    }
  }
  map.views.insert(map.views.begin() + static_cast<std::ptrdiff_t>(inserted),
                   {frame, pose.cam_from_world});
  for (const size_t inlier : pose.inliers) {
    map.points[point_of[matches[inlier].query]].observations.push_back(
        {inserted, matches[inlier].keypoint});
  }
  return true;
}

// A copy of the frame with only the features, which are all that bundle adjustment needs.
FramePointer WithoutWords(const Frame& frame) {
  auto reduced = std::make_shared<Frame>();
  reduced->id = frame.id;
  reduced->timestamp = frame.timestamp;
  reduced->features = frame.features;
  return reduced;
}

// Bundle adjustment of all views and points. Points with only one view after it are removed.
void AdjustMap(const Sensor& sensor, InitialMap& initial) {
  Map map;
  std::vector<KeyframeId> keyframes;
  for (const InitialMap::View& view : initial.views) {
    keyframes.push_back(map.AddKeyframe(WithoutWords(*view.frame), view.cam_from_world));
    if (keyframes.size() > 1) {
      SetParent(map, keyframes.back(), keyframes.front());
    }
  }
  std::vector<LandmarkId> landmarks;
  for (const InitialMap::Point& point : initial.points) {
    landmarks.push_back(map.AddLandmark(point.position, keyframes.front()));
    for (const InitialMap::Observation& seen : point.observations) {
      map.AddObservation(landmarks.back(), keyframes[seen.view], seen.keypoint);
    }
  }
  const BundleResult result = AdjustBundle(map, sensor, GlobalWindow(map, IslandId(0)),
                                           BundleOptions().ForWholeMap(), nullptr);
  if (!result.is_usable) {
    return;
  }
  ApplyBundle(map, result, sensor.levels);
  for (size_t i = 0; i < keyframes.size(); ++i) {
    initial.views[i].cam_from_world = map.CamFromWorld(keyframes[i]);
  }
  std::vector<InitialMap::Point> kept;
  for (const LandmarkId id : landmarks) {
    const Landmark* const landmark = map.landmarks().Find(id);
    if (landmark == nullptr || landmark->observations.size() < 2) {
      continue;
    }
    InitialMap::Point& point = kept.emplace_back();
    point.position = landmark->position;
    for (const Observation& seen : landmark->observations) {
      const auto view = std::find(keyframes.begin(), keyframes.end(), seen.keyframe);
      point.observations.push_back({static_cast<size_t>(view - keyframes.begin()), seen.keypoint});
    }
  }
  initial.points = std::move(kept);
}

int CountObservations(const InitialMap& map) {
  int count = 0;
  for (const InitialMap::Point& point : map.points) {
    count += static_cast<int>(point.observations.size());
  }
  return count;
}

// Corrects the views of an adjusted map and adjusts it again. If the correction makes it worse, the
// map stays as it is.
void CorrectShutterOf(const Sensor& sensor, InitialMap& map) {
  InitialMap corrected = map;
  if (!CorrectFrames(sensor, corrected)) {
    return;
  }
  AdjustMap(sensor, corrected);
  if (IsCorrectionKept(CountObservations(corrected), CountObservations(map))) {
    map = std::move(corrected);
  }
}

}  // namespace

MonocularInitialiser::MonocularInitialiser(const Sensor& sensor, uint64_t seed)
    : sensor_(sensor),
      seed_(seed),
      interval_(std::max(
          1U, static_cast<uint32_t>(std::lround(kReferenceInterval * sensor.frames_per_second)))) {}

MonocularInitialiser::Result MonocularInitialiser::Process(FramePointer frame) {
  if (frame->features.size() < kMinFeatures) {
    return {.map = std::nullopt, .failure = InitialisationFailure::kTooFewFeatures};
  }
  Result result = TryReferences(frame);
  if (result.map) {
    references_.clear();
  } else {
    KeepAsReference(std::move(frame));
  }
  return result;
}

// Returns the failure of the reference with which the frame came nearest to a map.
MonocularInitialiser::Result MonocularInitialiser::TryReferences(const FramePointer& frame) const {
  Result farthest{.map = std::nullopt, .failure = InitialisationFailure::kTooFewMatches};
  for (size_t i = 0; i < references_.size(); ++i) {
    Result result = TryReference(i, frame);
    if (result.map) {
      return result;
    }
    farthest.failure = std::max(farthest.failure, result.failure);
  }
  return farthest;
}

MonocularInitialiser::Result MonocularInitialiser::TryReference(size_t reference,
                                                                const FramePointer& frame) const {
  const FramePointer& first = references_[reference];
  const auto fail = [](InitialisationFailure failure) {
    return Result{.map = std::nullopt, .failure = failure};
  };
  const std::vector<Match> matches = MatchFrames(*first, *frame);
  if (matches.size() < kMinMatches) {
    return fail(InitialisationFailure::kTooFewMatches);
  }
  const TwoViewOptions options{.seed = HashSeed(seed_, frame->id.value, "two views"),
                               .min_points = kMinInitialPoints};
  const double least_shift = kMinShift * sensor_.camera.width;
  const double forward_share = 0.5 * options.forward_factor;
  if (TypicalShift(forward_share, *first, *frame, matches) < least_shift) {
    return fail(InitialisationFailure::kTooLittleParallax);
  }
  const TwoViews motion = EstimateTwoViews(
      sensor_.camera, MakePixelPairs(first->features, frame->features, matches, sensor_.levels),
      options);
  if (!motion.ok()) {
    return fail(ToInitialisationFailure(motion.failure));
  }
  if (!motion.is_forward && TypicalShift(0.5, *first, *frame, matches) < least_shift) {
    return fail(InitialisationFailure::kTooLittleParallax);
  }
  InitialMap map = MakeMap(first, frame, matches, motion);
  const size_t between = references_.size() - reference - 1;
  const size_t count = std::min(between, kFramesBetween);
  for (size_t i = 1; i <= count; ++i) {
    const FramePointer& other = references_[reference + i * between / count];
    if (!AddFrameBetween(sensor_, seed_, other, map)) {
      return fail(InitialisationFailure::kNotConfirmed);
    }
  }
  AdjustMap(sensor_, map);
  CorrectShutterOf(sensor_, map);  // the velocities of the views are not known before
  if (const auto failure = FinishInitialMap(map, motion.is_forward ? forward_share : 0.5)) {
    return fail(*failure);
  }
  return {.map = std::move(map), .failure = {}};
}

// Adds the frame. If there are too many references, removes the reference with the smallest time
// gap to its predecessor. So the references reach far back, and older references have larger gaps
// between them.
void MonocularInitialiser::KeepAsReference(FramePointer frame) {
  if (!references_.empty() && frame->id.value < references_.back()->id.value + interval_) {
    return;
  }
  references_.push_back(std::move(frame));
  if (references_.size() <= kMostReferences) {
    return;
  }
  size_t nearest = 1;
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 1; i + 1 < references_.size(); ++i) {
    const double gap = references_[i]->timestamp - references_[i - 1]->timestamp;
    if (gap < smallest) {
      smallest = gap;
      nearest = i;
    }
  }
  references_.erase(references_.begin() + static_cast<std::ptrdiff_t>(nearest));
}

}  // namespace hullslam
