// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// The entities that a bundle adjustment optimises or keeps fixed. Ids are in increasing order.
struct BundleWindow {
  std::vector<KeyframeId> moving;
  std::vector<KeyframeId> fixed;  // other keyframes that observe the landmarks
  std::vector<LandmarkId> landmarks;
  std::vector<ObjectId> objects;  // all have a shape, which is optimised unless locked
};

// The window around the keyframe `center`. The moving keyframes are `center` and those that share
// most landmarks with it, at most `max_moving` in all. The window has all landmarks that they
// observe. The fixed keyframes are those others that observe most of these landmarks, at most
// `max_fixed`; 0 stands for all, so that no observation of a moving landmark is ignored. The root
// of the spanning tree and tied keyframes (IsTied) never move. If there would be no fixed keyframe,
// the oldest moving one becomes fixed. With WindowObjects::kMapped the window also has the mapped
// objects that the moving keyframes observe.
enum class WindowObjects { kNone, kMapped };
BundleWindow LocalWindow(const Map& map, KeyframeId center, size_t max_moving, size_t max_fixed,
                         WindowObjects objects = WindowObjects::kNone);
// The objects that take part in bundle adjustment: the mapped ones, if the options say so.
WindowObjects ObjectsToAdjust(const ObjectOptions& options);
// All keyframes and landmarks of an island and, if asked for, its mapped objects. Only the root of
// the spanning tree and tied keyframes are fixed.
BundleWindow GlobalWindow(const Map& map, IslandId island,
                          WindowObjects objects = WindowObjects::kNone);

// Sorts the moving keyframes so that few blocks fill in if they are eliminated in this order: by
// approximate minimum degree in the covisibility graph (Amestoy et al. 1996).
void SortForElimination(const Map& map, BundleWindow& window);

}  // namespace hullslam
