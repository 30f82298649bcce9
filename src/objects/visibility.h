// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// What is known of an image in which an object is expected.
struct ImageKnowledge {
  const Frame& frame;
  const Rigid3& cam_from_world;
  std::span<const LandmarkId> landmarks;  // one per keypoint, or empty
  std::span<const ObjectId> objects;      // one per detection
};

// Whether an image should show a mapped object that it does not show: at least the share
// `min_inside` of the box of the projected ellipse is in the image, the object is not much farther
// away than it was ever seen, and nothing nearer hides it. What hides it is known from the frame's
// depth grid or, without depth, from its landmarks, and from the mapped objects that it shows.
// Where nothing is known, nothing hides the object.
bool ShouldShow(const Map& map, const Sensor& sensor, const ImageKnowledge& image,
                const ObjectLandmark& object, const ObjectOptions& options,
                double min_inside = 1.0);

// The same for the image of a keyframe.
bool ShouldShow(const Map& map, const Sensor& sensor, KeyframeId keyframe,
                const ObjectLandmark& object, const ObjectOptions& options,
                double min_inside = 1.0);

}  // namespace hullslam
