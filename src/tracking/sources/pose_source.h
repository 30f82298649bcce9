// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "tracking/last_frame.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// A way to get a first pose of a frame from the map and the last frame, which is up to date with
// the map (FollowMap). Null if it finds too little. Each source has its own file.
using PoseSource = std::optional<PoseEstimate>(const Frame& frame, const Map& map,
                                               const TrackingContext& context,
                                               const LastFrame& last);

// The last frame's landmarks are searched at the pose that a constant velocity predicts. Null
// without a prediction (PredictMotion, motion_model_source.cc).
PoseSource PoseByMotionModel;

// Keypoints are compared with those of the last frame's reference keyframe, whatever their
// positions in the image: with those of the same node of the vocabulary or, without words, with
// all. The refinement begins at the last frame's pose and, if less than half of the matches agree
// with its result, also at the pose that RANSAC finds (reference_keyframe_source.cc).
PoseSource PoseByReferenceKeyframe;

// Keyframes that look like the frame by their words give matches with their landmarks, from which
// RANSAC finds a pose; then all landmarks of that place are searched. Null if another place of the
// island explains the frame about as well. The last frame is not used (Mur-Artal and Tardos 2017;
// relocalisation_source.cc).
PoseSource PoseByRelocalisation;

// The arrangement of the mapped objects in the frame gives a pose, and hull lines and landmarks
// refine and confirm it. Null if another pose explains the frame about as well. The last frame is
// not used. If there are several islands, the one that agrees best is chosen
// (object_relocalisation_source.cc).
PoseSource PoseByObjects;

// Keypoints are compared with all landmarks of the last keyframes and of those that look like the
// frame, each keyframe by itself and all of an island together, wherever they are in the image. The
// pose with most inliers is taken. Slow; for images that are taken far apart. The last frame is not
// used (wide_match_source.cc).
PoseSource PoseByWideMatches;

// Whether words find another place of the keyframe's island that explains the frame about as well
// as the pose that was found near this keyframe (relocalisation_source.cc).
bool HasRival(const Frame& frame, const Map& map, const TrackingContext& context,
              KeyframeId keyframe, const PoseEstimate& found);

// All sources, in the order in which they are asked.
inline constexpr std::array<PoseSource*, 4> kPoseSources = {
    &PoseByMotionModel, &PoseByReferenceKeyframe, &PoseByRelocalisation, &PoseByObjects};

// The sources that need no last frame, in the same order.
inline constexpr std::array<PoseSource*, 2> kRelocalisationSources = {&PoseByRelocalisation,
                                                                      &PoseByObjects};

// The sources for a frame that none of the others found.
inline constexpr std::array<PoseSource*, 1> kWideSources = {&PoseByWideMatches};

// Whether the source begins at the last frame. The others may find another place or island, whose
// poses do not fit exactly to those of the last frame.
constexpr bool BeginsAtLastFrame(PoseSource* source) {
  return source != &PoseByWideMatches &&
         std::find(kRelocalisationSources.begin(), kRelocalisationSources.end(), source) ==
             kRelocalisationSources.end();
}

}  // namespace hullslam
