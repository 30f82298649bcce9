// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Where a frame shows a mapped object: its landmarks belong to the keypoints there.
struct ObjectGuide {
  std::vector<LandmarkId> landmarks;  // on the object and not known yet, by increasing id
  std::vector<uint8_t> is_outside;    // one a keypoint: 0 in the detection's hull or near it
};

// The landmarks on an object with a shape: those in its masks in its keyframes (20 of them at most)
// that lie in its ellipsoid or near it, which those of the background do not. By increasing id,
// without the known ones (one entry an id).
std::vector<LandmarkId> LandmarksOn(const Map& map, const ObjectLandmark& object,
                                    const std::vector<bool>& is_known);

// A guide for each detection of the frame that shows an object with landmarks that are not known;
// `objects` has one entry a detection, invalid for none (FindMappedObjects), or is empty. After
// VOOM (Wang et al. 2024), where objects bring in the landmarks on them, however few of these their
// keyframes share with the frame.
std::vector<ObjectGuide> GuideByObjects(const Map& map, const Frame& frame,
                                        std::span<const ObjectId> objects,
                                        const std::vector<bool>& is_known);

}  // namespace hullslam
