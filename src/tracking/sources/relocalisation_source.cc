// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>
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
// If another place has this share of the inliers, the frame is ambiguous. In other light two in
// five points of the same place look different.
constexpr double kRivalShare = 0.5;

// The keyframes that look like the frame, one per place.
std::vector<KeyframeId> FindPlaces(const Frame& frame, const Map& map) {
  std::vector<SimilarKeyframe> similar = map.index().Query(map.VectorOf(frame));
  KeepMostCommon(similar);
  std::vector<KeyframeId> places = BestOfPlaces(map, similar);
  places.resize(std::min(places.size(), kMostPlaces));
  return places;
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

// The pose at the place of a keyframe, from matches by words with its landmarks first. Null if too
// few landmarks agree.
std::optional<PoseEstimate> PoseAt(const Frame& frame, const Map& map,
                                   const TrackingContext& context, KeyframeId keyframe) {
  std::optional<PoseEstimate> estimate =
      PoseOfMatches(frame, map, context, MatchLandmarksByWords(map, frame, keyframe, {}),
                    context.min_reference_matches(), "relocalisation");
  if (!estimate || estimate->inliers < context.min_start_inliers()) {
    return std::nullopt;
  }
  return SeeWholePlace(frame, map, context, keyframe, std::move(*estimate));
}

bool HasWords(const Frame& frame, const Map& map, const TrackingContext& context) {
  return context.options.relocalise_by_words && map.vocabulary() != nullptr &&
         !frame.words.is_absent();
}

}  // namespace

bool HasRival(const Frame& frame, const Map& map, const TrackingContext& context,
              KeyframeId keyframe, const PoseEstimate& found) {
  if (!HasWords(frame, map, context)) {
    return false;
  }
  const auto is_elsewhere = [&](const Rigid3& pose) {
    return !AreSamePlace(found.cam_from_world, pose, found.median_depth);
  };
  std::vector<KeyframeId> covered = PlaceOf(map, keyframe);
  size_t tried = 0;
  for (const SimilarKeyframe& similar : map.index().Query(map.VectorOf(frame))) {
    const KeyframeId other = similar.keyframe;
    if (std::ranges::count(covered, other) > 0 || IslandOf(map, other) != IslandOf(map, keyframe) ||
        !is_elsewhere(map.keyframes().At(other).cam_from_world)) {
      continue;
    }
    const auto rival = PoseAt(frame, map, context, other);
    if (rival && is_elsewhere(rival->cam_from_world) &&
        rival->inliers >= kRivalShare * found.inliers) {
      return true;
    }
    if (++tried == kMostPlaces) {
      break;
    }
    std::ranges::copy(PlaceOf(map, other), std::back_inserter(covered));
  }
  return false;
}

std::optional<PoseEstimate> PoseByRelocalisation(const Frame& frame, const Map& map,
                                                 const TrackingContext& context,
                                                 const LastFrame& /*last*/) {
  if (!HasWords(frame, map, context)) {
    return std::nullopt;
  }
  for (const KeyframeId keyframe : FindPlaces(frame, map)) {
    std::optional<PoseEstimate> estimate = PoseAt(frame, map, context, keyframe);
    if (estimate && estimate->inliers >= context.min_relocalisation_inliers()) {
      return HasRival(frame, map, context, keyframe, *estimate) ? std::nullopt : estimate;
    }
  }
  return std::nullopt;
}

}  // namespace hullslam
