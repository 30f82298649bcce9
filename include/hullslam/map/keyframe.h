// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/util/id.h"

namespace hullslam {

// The pose of a camera relative to a keyframe. It follows the keyframe when the map is adjusted or
// corrected. Map::RelativeTo makes one, Map::CamFromWorld gives its pose in the current map.
struct RelativePose {
  KeyframeId reference;
  Rigid3 cam_from_reference;  // translation in the unit of length that the reference had then
  // Keyframe::scale of the reference when the relative pose was made. If the reference has another
  // scale later, the translation is multiplied by the later scale over this one.
  double reference_scale = 1.0;
};

struct Covisible {
  KeyframeId keyframe;
  int shared = 0;  // landmarks that both observe
};

struct Keyframe {
  std::shared_ptr<const Frame> frame;
  Rigid3 cam_from_world;
  // The product of the scales of all corrections since the keyframe was made: a length of 1 at that
  // time has this length in the current map. It is 1 in RGB-D runs, in which corrections keep the
  // scale.
  double scale = 1.0;
  std::vector<LandmarkId> landmarks;  // one per keypoint; invalid where it observes no landmark
  std::vector<ObjectId> objects;      // one per detection; invalid where it shows no object
  std::vector<Covisible> covisible;   // by increasing keyframe id
  KeyframeId parent;                  // in the spanning tree; invalid for its root
  std::vector<KeyframeId> children;   // by increasing id
  std::vector<KeyframeId> loops;      // joined to this one by a loop closure, by increasing id
  IslandId island{0};                 // the part of the map that it belongs to (Map::BeginIsland)
};

// The record of a culled keyframe, by which frames that were tracked relative to it still have a
// pose.
struct CulledKeyframe {
  FrameId frame;
  // The pose relative to the parent, which may be culled later itself. It has no reference if the
  // keyframe was removed with its island: then the keyframe has no pose, and neither have the
  // frames that refer to it.
  RelativePose pose;
  double scale = 1.0;  // Keyframe::scale when it was culled
};

}  // namespace hullslam
