// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

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

}  // namespace hullslam
