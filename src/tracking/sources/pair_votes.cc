// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/pair_votes.h"

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

#include "estimators/two_views.h"
#include "hullslam/geometry/rigid3.h"
#include "places/landmark_search.h"
#include "places/similar_places.h"
#include "util/hash.h"

namespace hullslam {
namespace {

double SigmaOf(const Keypoint& keypoint, const ScaleLevels& levels) {
  return static_cast<double>(levels.scale[static_cast<size_t>(keypoint.level)]);
}

}  // namespace

std::vector<PixelPair> MakePixelPairs(const FrameFeatures& a, const FrameFeatures& b,
                                      std::span<const Match> matches, const ScaleLevels& levels) {
  std::vector<PixelPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& match : matches) {
    const Keypoint& in_a = a.keypoints[match.query];
    const Keypoint& in_b = b.keypoints[match.keypoint];
    pairs.push_back({.a = in_a.undistorted.cast<double>(),
                     .b = in_b.undistorted.cast<double>(),
                     .sigma_a = SigmaOf(in_a, levels),
                     .sigma_b = SigmaOf(in_b, levels)});
  }
  return pairs;
}

namespace {

// Of right poses, the rotations of most pairs are within a degree; of wrong ones they are 3 to 17
// degrees off (freiburg1_xyz, every 20th and 30th image).
constexpr double kMaxRotation = 2.0 * std::numbers::pi / 180.0;
// A pair needs fewer points here than where a map begins with them.
constexpr size_t kMinPoints = 20;
constexpr double kMinShare = 0.5;

}  // namespace

PairVotes VoteByPairs(const Frame& frame, const Map& map, const TrackingContext& context,
                      const LocalTracking& tracking) {
  PairVotes votes;
  const TwoViewOptions options{.seed = HashSeed(context.seed, frame.id.value, "pair votes"),
                               .min_points = kMinPoints,
                               .min_share = kMinShare};
  for (const KeyframeId id : PlaceOf(map, tracking.reference)) {
    const Keyframe& keyframe = map.keyframes().At(id);
    const FrameFeatures& seen = keyframe.frame->features;
    std::vector<uint32_t> all(seen.size());
    std::iota(all.begin(), all.end(), 0U);
    const std::vector<Match> matches = MatchWidely(seen, all, frame.features);
    const TwoViews motion = EstimateTwoViews(
        context.sensor.camera, MakePixelPairs(seen, frame.features, matches, context.sensor.levels),
        options);
    if (motion.ok()) {
      const Rigid3 expected = tracking.estimate.cam_from_world * Inverse(keyframe.cam_from_world);
      const double difference = AngularDistance(motion.b_from_a.rotation, expected.rotation);
      (difference < kMaxRotation ? votes.agree : votes.contradict) += 1;
    }
  }
  return votes;
}

}  // namespace hullslam
