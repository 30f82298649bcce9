// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// What a bundle adjustment optimises and what it keeps fixed. Ids are in increasing order.
struct BundleWindow {
  std::vector<KeyframeId> moving;
  std::vector<KeyframeId> fixed;  // they observe the landmarks too
  std::vector<LandmarkId> landmarks;
  std::vector<ObjectId> objects;  // their quadrics are optimised; all of them have a shape
};

// The keyframe `center` and those it shares most landmarks with (at most `max_moving` in all) move.
// The window has all landmarks that they observe. Of the other keyframes, those that observe most
// of these landmarks are fixed (at most `max_fixed`; 0: all, so that no observation of a landmark
// is ignored while it moves). The root of the spanning tree never moves. If no keyframe would be
// fixed, the oldest one is. With WindowObjects::kMapped the window also has the mapped objects that
// the moving keyframes observe.
enum class WindowObjects { kNone, kMapped };
BundleWindow LocalWindow(const Map& map, KeyframeId center, size_t max_moving, size_t max_fixed,
                         WindowObjects objects = WindowObjects::kNone);
// The objects that take part in bundle adjustment: the mapped ones, if the options say so.
WindowObjects ObjectsToAdjust(const ObjectOptions& options);
// All keyframes and landmarks of an island and, if asked for, its mapped objects. Only the root of
// the spanning tree is fixed.
BundleWindow GlobalWindow(const Map& map, IslandId island,
                          WindowObjects objects = WindowObjects::kNone);

}  // namespace hullslam
