// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "map/located_landmarks.h"

namespace hullslam {

// The map as a pose graph in the text format of g2o (https://github.com/RainerKuemmerle/g2o):
// VERTEX_SE3:QUAT for each keyframe (its id; the pose world_from_cam), of which the first is fixed;
// VERTEX_TRACKXYZ for each landmark (ids after the keyframes); EDGE_SE3:QUAT for each pair
// of keyframes that are covisible, joined by a loop, or parent and child in the spanning tree.
//
// The measurements of the edges agree with the map, so its graph is at its optimum as it is. The
// information of an edge comes from the landmarks that both keyframes observe: of their keypoints
// in the second keyframe, with the landmarks fixed in the first one. It is too large by the
// uncertainty of the landmarks. With fewer than six common landmarks it is the identity.
std::string FormatG2o(const Map& map, const LocatedLandmarks& located, const Sensor& sensor);

}  // namespace hullslam
