// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The landmarks on a mapped object, and the part of a frame where they are searched.
struct ObjectGuide {
  std::vector<LandmarkId> landmarks;  // on the object and not known yet, by increasing id
  std::vector<uint8_t> is_outside;    // one per keypoint; 0 in or near the detection's hull
};

// The landmarks on an object with a shape: those that its keyframes (at most 20 of them) see in its
// masks and that lie in or near its ellipsoid, unlike those of the background. By increasing id.
// Known landmarks are left out (`is_known`: by landmark id).
std::vector<LandmarkId> LandmarksOn(const Map& map, const ObjectLandmark& object,
                                    const std::vector<bool>& is_known);

// A guide for each detection of the frame that shows an object with unknown landmarks. `objects`
// has one entry per detection, invalid for none (FindMappedObjects), or is empty. After VOOM (Wang
// et al. 2024): an object brings in the landmarks on it, even if its keyframes share few or no
// landmarks with the frame.
std::vector<ObjectGuide> GuideByObjects(const Map& map, const Frame& frame,
                                        std::span<const ObjectId> objects,
                                        const std::vector<bool>& is_known);

}  // namespace hullslam
