// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Nothing of the road is nearer to its camera than so many metres.
inline constexpr double kRoadNearest = 30.0;

// A valley with houses, seen from a bridge high above it. The light is the same everywhere.
void FurnishRoad(SceneBuilder& builder);

// The drive over the bridge, a metre per frame, with slow turns and bumps.
struct RoadPath {
  double phase = 0.0;  // radians, of turns and bumps
  Rigid3 WorldFromCam(double time) const;
};

// The camera of KITTI's sequences 00 to 02 (Geiger et al. 2012): 1226x370 px, f 718.9 px. Its
// stereo pair has a baseline of 0.54 m.
PinholeCamera RoadCamera();

}  // namespace hullslam::synthetic
