// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "util/id_set.h"

namespace hullslam {

// A detection that shows a mapped object. The object's landmarks are searched at the keypoints
// inside it.
struct ObjectGuide {
  std::vector<LandmarkId> landmarks;  // on the object and not known yet, by increasing id
  std::vector<uint8_t> is_outside;    // one per keypoint: 0 inside the detection's hull or near it
};

// The landmarks on an object with a shape: those that its masks show and that lie inside its
// ellipsoid or near it (NearSurface). Landmarks of the background in the masks lie farther away. By
// increasing id, without the known ones.
std::vector<LandmarkId> LandmarksOn(const Map& map, const ObjectLandmark& object,
                                    const IdSet<LandmarkId>& known,
                                    const ObjectOptions& options = {});

// A guide for each detection of the frame that shows an object with landmarks that are not known.
// `objects` has one entry per detection, invalid where it shows no mapped object
// (FindMappedObjects), or is empty. As in VOOM (Wang et al. 2024), an object gives access to its
// landmarks even if the frame shares few landmarks with the object's keyframes.
std::vector<ObjectGuide> GuideByObjects(const Map& map, const Frame& frame,
                                        std::span<const ObjectId> objects,
                                        const IdSet<LandmarkId>& known,
                                        const ObjectOptions& options = {});

}  // namespace hullslam
