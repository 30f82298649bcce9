// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "matching/match.h"

namespace hullslam {

// A keypoint of a frame and the landmark that it shows.
struct FoundLandmark {
  uint32_t keypoint = 0;
  LandmarkId landmark;
};

// Searches landmarks in a frame whose pose is assumed to be `cam_from_world`. This pose comes from
// place recognition and may differ from the pose of tracking. Each keypoint and each landmark is
// found at most once, and the projection of a found landmark agrees with its keypoint (IsInlier).
std::vector<FoundLandmark> FindLandmarks(const Map& map, const Sensor& sensor, const Frame& frame,
                                         const Rigid3& cam_from_world,
                                         const std::vector<LandmarkId>& landmarks);

// Finds the landmarks of a keyframe that the keypoints of a frame may show. Only the words and the
// descriptors are compared; no pose is needed. If `is_asked` is not empty, it has one entry per
// keypoint of the frame, and keypoints whose entry is 0 are left out. The map must have a
// vocabulary.
std::vector<FoundLandmark> MatchLandmarksByWords(const Map& map, const Frame& frame,
                                                 KeyframeId keyframe,
                                                 const std::vector<uint8_t>& is_asked);

// Matches between images that are taken far apart: nothing predicts where a landmark is in the
// image, and the images may have few words in common.

// The keyframes with which a frame is compared, each once: first those nearest in time, then, if
// there is a vocabulary, those that look like it most by their words. Keyframes of the island
// `left_out` are left out.
std::vector<KeyframeId> KeyframesForWideMatches(const Map& map, const Frame& frame,
                                                IslandId left_out = IslandId());

// The keypoints of `queries` that are listed in `indices` (Match::query) and the keypoints of
// `features` that have nearly the same descriptors.
std::vector<Match> MatchWidely(const FrameFeatures& queries, std::span<const uint32_t> indices,
                               const FrameFeatures& features);

// The landmarks of a keyframe that are found in the frame by their descriptors alone: each is
// compared with all keypoints.
std::vector<FoundLandmark> MatchLandmarksOf(const Map& map, const Frame& frame,
                                            KeyframeId keyframe);

}  // namespace hullslam
