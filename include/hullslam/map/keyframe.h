// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/frame/frame.h"
#include "hullslam/util/id.h"

namespace hullslam {

struct Covisible {
  KeyframeId keyframe;
  int shared = 0;  // landmarks that both observe
};

struct Keyframe {
  std::shared_ptr<const Frame> frame;
  Rigid3 cam_from_world;
  std::vector<LandmarkId> landmarks;  // one a keypoint, invalid where it observes none
  std::vector<ObjectId> objects;      // one a detection, invalid where it is of none
  std::vector<Covisible> covisible;   // by increasing keyframe id
  KeyframeId parent;                  // in the spanning tree; invalid for its root
  std::vector<KeyframeId> children;   // by increasing id
};

// What is kept of a culled keyframe, so that frames tracked relative to it still have a pose.
struct CulledKeyframe {
  FrameId frame;
  KeyframeId parent;  // may itself be culled later
  Rigid3 cam_from_parent;
};

}  // namespace hullslam
