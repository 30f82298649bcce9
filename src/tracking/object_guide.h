// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

<<<<<<< HEAD
// The landmarks on a mapped object, and the part of a frame where they are searched.
struct ObjectGuide {
  std::vector<LandmarkId> landmarks;  // on the object and not known yet, by increasing id
  std::vector<uint8_t> is_outside;    // one per keypoint; 0 in or near the detection's hull
};

// The landmarks on an object with a shape: those that its keyframes (at most 20 of them) see in its
// masks and that lie in or near its ellipsoid, unlike those of the background. By increasing id.
// Known landmarks are left out (`is_known`: by landmark id).
=======
// A detection that shows a mapped object: the object's landmarks are searched at the keypoints in
// it.
struct ObjectGuide {
  std::vector<LandmarkId> landmarks;  // on the object and not known yet, by increasing id
  std::vector<uint8_t> is_outside;    // one per keypoint: 0 in the detection's hull or near it
};

// The landmarks on an object with a shape: those in its masks in its keyframes that lie in its
// ellipsoid or near it (NearSurface), which landmarks of the background do not. By increasing id,
// without the known ones (one entry per id).
>>>>>>> obj
std::vector<LandmarkId> LandmarksOn(const Map& map, const ObjectLandmark& object,
                                    const std::vector<bool>& is_known,
                                    const ObjectOptions& options = {});

<<<<<<< HEAD
// A guide for each detection of the frame that shows an object with unknown landmarks. `objects`
// has one entry per detection, invalid for none (FindMappedObjects), or is empty. After VOOM (Wang
// et al. 2024): an object brings in the landmarks on it, even if its keyframes share few or no
// landmarks with the frame.
=======
// A guide for each detection of the frame that shows an object with landmarks that are not known;
// `objects` has one entry per detection, invalid for none (FindMappedObjects), or is empty. After
// VOOM (Wang et al. 2024), where objects bring in their landmarks, however few of them the frame
// shares with the object's keyframes.
>>>>>>> obj
std::vector<ObjectGuide> GuideByObjects(const Map& map, const Frame& frame,
                                        std::span<const ObjectId> objects,
                                        const std::vector<bool>& is_known,
                                        const ObjectOptions& options = {});

}  // namespace hullslam
