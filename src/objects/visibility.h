// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "map/contradictions.h"

namespace hullslam {

// The known contents of an image in which an object is expected.
struct ImageKnowledge {
  const Frame& frame;
  const Rigid3& cam_from_world;
  std::span<const LandmarkId> landmarks;  // one per keypoint, or empty
  std::span<const ObjectId> objects;      // one per detection
};

// The observation of the location of an object in an image.
enum class LocationVisibility {
  kOutside,  // the location is not in the image, or farther away than the object was ever seen
  kHidden,   // something nearer hides it
  kVisible,
};

// A location is in the image if at least the share `min_inside` of the box of the projected ellipse
// is. Whether something hides it is decided from the frame's depth grid or, without depth, from its
// landmarks, and from the mapped objects that the frame shows. If none of these is known there, the
// location counts as visible.
LocationVisibility FindVisibility(const Map& map, const Sensor& sensor, const ImageKnowledge& image,
                                  const ObjectLandmark& object, const ObjectOptions& options,
                                  double min_inside = 1.0);

// The same for the image of a keyframe.
LocationVisibility FindVisibility(const Map& map, const Sensor& sensor, KeyframeId keyframe,
                                  const ObjectLandmark& object, const ObjectOptions& options,
                                  double min_inside = 1.0);

// The surface that an image shows where an ellipsoid should be: medians over the samples near its
// centre, along the viewing direction, m.
struct SeenSurface {
  double behind = 0.0;     // behind the near side of the ellipsoid; negative if in front of it
  double thickness = 0.0;  // of the ellipsoid
};

// From the depth image or, without one, from the landmarks that the image shows. Nothing if there
// are too few samples.
std::optional<SeenSurface> MeasureSurface(const Map& map, const Sensor& sensor,
                                          const ImageKnowledge& image, const Ellipsoid& ellipsoid);

// Whether the depth of an image shows that the ellipsoid is not there: at least the share
// `min_share` of the depth samples near its centre were measured behind it. False if there are too
// few samples. Unlike FindVisibility this does not ask whether a detector would have found the
// object so far away or cut by the border of the image.
bool SeesThrough(const Sensor& sensor, const Frame& frame, const Rigid3& cam_from_world,
                 const Ellipsoid& ellipsoid, double min_share);

// Whether the object has moved away since it was observed last: the depth images of the keyframe
// `current` and of so many earlier ones that they are ChangeOptions::min_keyframes show what is
// behind the object (SeesThrough). So it does not matter how many keyframes have observed it
// before, and a detector that misses it is no reason. To be called once per keyframe and object.
bool IsContradicted(const Map& map, const Sensor& sensor, KeyframeId current, ObjectId id,
                    const ChangeOptions& options, Contradictions<ObjectId>& contradictions);

}  // namespace hullslam
