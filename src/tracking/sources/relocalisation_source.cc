// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>
#include <vector>

#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "objects/pose_hypotheses.h"
#include "places/landmark_search.h"
#include "places/similar_places.h"
#include "tracking/sources/confirmed_pose.h"
#include "tracking/sources/pose_source.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kMostPlaces = 8;  // largest number of places that are tried for a frame
// If another place has this share of the inliers of the best one, the frame is ambiguous.
constexpr double kRivalShare = 0.75;

// The keyframes that look like the frame, one per place.
std::vector<KeyframeId> FindPlaces(const Frame& frame, const Map& map) {
  std::vector<SimilarKeyframe> similar = map.index().Query(map.VectorOf(frame));
  KeepMostCommon(similar);
  std::vector<KeyframeId> places = BestOfPlaces(map, similar);
  places.resize(std::min(places.size(), kMostPlaces));
  return places;
}

// The pose from matches by words with the landmarks of one keyframe. Null if too few agree.
std::optional<PoseEstimate> PoseByWords(const Frame& frame, const Map& map,
                                        const TrackingContext& context, KeyframeId keyframe) {
  return PoseOfMatches(frame, map, context, MatchLandmarksByWords(map, frame, keyframe, {}),
                       context.min_reference_matches(), "relocalisation");
}

// Adds landmarks of the place that are seen from the estimated pose, and refines the pose.
PoseEstimate SeeWholePlace(const Frame& frame, const Map& map, const TrackingContext& context,
                           KeyframeId keyframe, PoseEstimate estimate) {
  IdSet<LandmarkId> known;
  for (const LandmarkId id : estimate.landmarks) {
    if (id.IsValid()) {
      known.Insert(id);
    }
  }
  for (const auto& [keypoint, landmark] :
       FindLandmarks(map, context.sensor, frame, estimate.cam_from_world,
                     ObservedLandmarks(map, PlaceOf(map, keyframe)))) {
    if (!estimate.landmarks[keypoint].IsValid() && known.Insert(landmark)) {
      estimate.landmarks[keypoint] = landmark;
    }
  }
  return RefinePose(frame, map, context, {}, std::move(estimate));
}

}  // namespace

std::optional<PoseEstimate> PoseByRelocalisation(const Frame& frame, const Map& map,
                                                 const TrackingContext& context,
                                                 const LastFrame& /*last*/) {
  const bool has_words = map.vocabulary() != nullptr && !frame.words.is_absent();
  if (!context.options.relocalise_by_words || !has_words) {
    return std::nullopt;
  }
  std::optional<PoseEstimate> best;
  KeyframeId best_keyframe;
  for (const KeyframeId keyframe : FindPlaces(frame, map)) {
    std::optional<PoseEstimate> estimate = PoseByWords(frame, map, context, keyframe);
    if (!estimate || estimate->inliers < context.min_start_inliers()) {
      continue;
    }
    *estimate = SeeWholePlace(frame, map, context, keyframe, std::move(*estimate));
    if (estimate->inliers < context.min_relocalisation_inliers()) {
      continue;
    }
    const bool is_elsewhere =
        best && IslandOf(map, keyframe) == IslandOf(map, best_keyframe) &&
        !AreSamePlace(best->cam_from_world, estimate->cam_from_world, best->median_depth);
    const auto [fewer, more] = std::minmax({estimate->inliers, best ? best->inliers : 0});
    if (is_elsewhere && fewer >= kRivalShare * more) {
      return std::nullopt;
    }
    if (!best || (is_elsewhere && estimate->inliers > best->inliers)) {
      best = std::move(estimate);
      best_keyframe = keyframe;
    }
  }
  return best;
}

}  // namespace hullslam
