// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/confirmed_pose.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "estimators/absolute_pose.h"
#include "frame/measure_point.h"
#include "places/depth_agreement.h"
#include "places/similar_places.h"
#include "tracking/sources/pair_votes.h"
#include "util/hash.h"

namespace hullslam {
namespace {

// The landmarks of the local map are searched within kLocalSearchRadius of where the pose places
// them. If a pose may place them further off than that, by three standard deviations, those that
// are found elsewhere in the image do not confirm it, and the next frame begins at a wrong place.
constexpr double kMostCornerSigma = kLocalSearchRadius / 3.0;

// Where images are far apart, the local map is large and errors are, so at any pose some landmarks
// are found by chance: at wrong poses up to one in 75 of those that should be visible.
constexpr size_t kVisiblePerChance = 75;
// Frames so near in time may be expected to show the same place. Another one that seems to show it
// may only look alike, so three times as many inliers are needed as without the larger errors.
constexpr uint32_t kNeighbouringFrames = 5;
constexpr int kFarReturn = 3;
// The largest share of depth samples that may be seen past. Of wrong poses it was up to a quarter,
// of right ones at most 9 % with the depth of a phone.
constexpr double kMostPast = 0.1;
// So many pairs must confirm a pose. Of freiburg1_xyz (every 20th and 30th image, twenty starts) 5
// of 647 poses are more than 50 mm off without votes, 3 of 625 with one pair, and none with two.
constexpr int kLeastPairs = 2;

// Whether so few landmarks are found among images that are far apart that the place may be another.
bool CanBeChance(const Frame& frame, const Map& map, const TrackingContext& context,
                 const LocalTracking& tracking) {
  const uint32_t reference = map.keyframes().At(tracking.reference).frame->id.value;
  const auto [first, last] = std::minmax(reference, frame.id.value);
  const int needed = last - first <= kNeighbouringFrames
                         ? context.options.min_inliers
                         : kFarReturn * context.min_relocalisation_inliers();
  const auto chance = static_cast<int>(tracking.visible.size() / kVisiblePerChance);
  return tracking.estimate.EffectiveInliers() <
         std::max(needed, context.options.min_inliers + chance);
}

// Whether depth images contradict a pose: the frame sees past what the keyframes of the place have
// seen, or they past what the frame sees. A place that only looks alike has other things in it.
bool IsContradicted(const Frame& frame, const Map& map, const TrackingContext& context,
                    const LocalTracking& tracking) {
  DepthAgreement agreement;
  for (const KeyframeId id : PlaceOf(map, tracking.reference)) {
    const Keyframe& keyframe = map.keyframes().At(id);
    agreement.Add(CompareDepths(context.sensor, frame, *keyframe.frame,
                                keyframe.cam_from_world * Inverse(tracking.estimate.cam_from_world),
                                context.is_wide ? 1.0 / kWideErrorFactor : 1.0));
  }
  return agreement.past > kMostPast * agreement.compared();
}

// Whether neither landmarks nor objects alone confirm a pose that objects began. Landmarks were
// searched near it, so some agree by chance: up to 27 with wrong poses from shifted masks.
bool IsBarelyConfirmed(const TrackingContext& context, const PoseEstimate& estimate) {
  return estimate.inliers < context.min_relocalisation_inliers() &&
         PoseEstimate::kLandmarksPerObject * estimate.used_objects < context.options.min_inliers;
}

// Whether pairs of images do not confirm a pose among images that are far apart. Without depth
// nothing but the landmarks has been compared, and few of these may agree with a wrong pose.
bool IsDoubted(const Frame& frame, const Map& map, const TrackingContext& context,
               const LocalTracking& tracking) {
  if (!context.is_wide || !context.sensor.IsMonocular()) {
    return false;
  }
  const PairVotes votes = VoteByPairs(frame, map, context, tracking);
  return votes.agree < kLeastPairs || votes.contradict > votes.agree;
}

}  // namespace

std::optional<PoseEstimate> PoseOfMatches(const Frame& frame, const Map& map,
                                          const TrackingContext& context,
                                          std::span<const FoundLandmark> matches,
                                          size_t min_inliers, std::string_view purpose) {
  std::vector<PoseObservation> observations;
  observations.reserve(matches.size());
  for (const auto& [keypoint, landmark] : matches) {
    observations.push_back({.point = map.landmarks().At(landmark).position,
                            .measurement = MeasurePoint(context.sensor, frame.features, keypoint,
                                                        context.sensor.depth_error)});
  }
  RansacOptions ransac;
  ransac.seed = HashSeed(context.seed, frame.id.value, purpose);
  ransac.min_inliers = min_inliers;
  const AbsolutePose pose = EstimateAbsolutePose(context.sensor.camera, observations, ransac);
  if (!pose.ok()) {
    return std::nullopt;
  }
  PoseEstimate estimate;
  estimate.cam_from_world = pose.cam_from_world;
  estimate.landmarks.resize(frame.features.size());
  for (const size_t inlier : pose.inliers) {
    estimate.landmarks[matches[inlier].keypoint] = matches[inlier].landmark;
  }
  return RefinePose(frame, map, context, {}, std::move(estimate));
}

PoseSearch FindConfirmedPose(const Frame& frame, const Map& map, const TrackingContext& context,
                             const LastFrame& last, std::span<PoseSource* const> sources) {
  PoseSearch search;
  int most = 0;
  for (size_t i = 0; i < sources.size(); ++i) {
    if (search.found && !BeginsAtLastFrame(sources[i])) {
      break;
    }
    std::optional<PoseEstimate> start = sources[i](frame, map, context, last);
    if (!start) {
      continue;
    }
    const bool is_certain = start->EffectiveInliers() >= context.min_relocalisation_inliers();
    const bool is_by_objects = start->keyframe_of_place.IsValid() && !context.is_wide;
    const KeyframeId near =
        start->keyframe_of_place.IsValid() ? start->keyframe_of_place : last.reference;
    LocalTracking tracking = TrackLocalMap(frame, map, context, near, std::move(*start));
    const int inliers = tracking.estimate.EffectiveInliers();
    const bool is_new_place = context.is_wide || !BeginsAtLastFrame(sources[i]);
    if (inliers < context.options.min_inliers ||
        tracking.estimate.corner_sigma > kMostCornerSigma ||
        (context.is_wide && CanBeChance(frame, map, context, tracking)) ||
        (is_by_objects && IsBarelyConfirmed(context, tracking.estimate)) ||
        (is_new_place && IsContradicted(frame, map, context, tracking)) ||
        IsDoubted(frame, map, context, tracking)) {
      search.most_unconfirmed = std::max(search.most_unconfirmed, inliers);
      continue;
    }
    if (inliers > most) {
      most = inliers;
      search.found = ConfirmedPose{std::move(tracking), i};
    }
    if (is_certain) {
      break;
    }
  }
  return search;
}

}  // namespace hullslam
