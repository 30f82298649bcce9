// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "places/landmark_search.h"
#include "tracking/last_frame.h"
#include "tracking/local_map_tracking.h"
#include "tracking/pose_refinement.h"
#include "tracking/sources/pose_source.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The pose on which most of the matches between keypoints of the frame and landmarks agree, found
// by RANSAC without an initial pose and then refined. The estimate has the landmarks that agree.
// Null if fewer than `min_inliers` agree. `purpose` makes the samples different from those of other
// searches for the same frame.
std::optional<PoseEstimate> PoseOfMatches(const Frame& frame, const Map& map,
                                          const TrackingContext& context,
                                          std::span<const FoundLandmark> matches,
                                          size_t min_inliers, std::string_view purpose);

// A frame whose pose is confirmed by its local map, and the source of its first pose.
struct ConfirmedPose {
  LocalTracking tracking;
  size_t source = 0;  // index into the sources that were asked
};

struct PoseSearch {
  std::optional<ConfirmedPose> found;
  // The most landmarks and objects (EffectiveInliers) of a pose that was not confirmed.
  int most_unconfirmed = 0;
};

// Asks the sources one after the other for a first pose of the frame. A pose is confirmed if the
// local map finds tracking.min_inliers landmarks with it and if these determine it in the whole
// image: landmarks along one edge agree with many poses. The first confirmed pose is the result if
// its source found as many landmarks as relocalisation needs. With fewer, its matches may agree by
// chance, so the other sources that begin at the last frame are asked too, and the pose with most
// landmarks of the local map is the result.
PoseSearch FindConfirmedPose(const Frame& frame, const Map& map, const TrackingContext& context,
                             const LastFrame& last, std::span<PoseSource* const> sources);

}  // namespace hullslam
