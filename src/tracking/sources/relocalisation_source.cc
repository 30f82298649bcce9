// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>
#include <vector>

#include "map/keyframe_graph.h"
#include "places/landmark_search.h"
#include "places/similar_places.h"
#include "tracking/sources/confirmed_pose.h"
#include "tracking/sources/pose_source.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kMostPlaces = 8;  // largest number of places that are tried for a frame

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
  for (const KeyframeId keyframe : FindPlaces(frame, map)) {
    std::optional<PoseEstimate> estimate = PoseByWords(frame, map, context, keyframe);
    if (!estimate || estimate->inliers < context.min_start_inliers()) {
      continue;
    }
    *estimate = SeeWholePlace(frame, map, context, keyframe, std::move(*estimate));
    if (estimate->inliers >= context.min_relocalisation_inliers()) {
      return estimate;
    }
  }
  return std::nullopt;
}

}  // namespace hullslam
