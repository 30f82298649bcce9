// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>

#include "frame/keypoint_grid.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "util/hash.h"

namespace hullslam {

// Builds the grid of the frame again after its keypoints were changed.
inline void RebuildGrid(const Sensor& sensor, Frame& frame) {
  frame.features.grid = MakeKeypointGrid(frame.features.keypoints, sensor.camera);
}

// Adds keypoints at a depth of 1 m that no other frame shows. If there are more than 70 of them,
// and the frame tracks fewer than 100 close points, the tracker asks for a keyframe.
inline void AddUnknownPoints(const Sensor& sensor, int count, int level, Frame& frame) {
  std::mt19937_64 random(HashSeed(0, frame.id.value, "unknown points"));
  std::uniform_real_distribution<float> u(100.0f, 600.0f);
  std::uniform_real_distribution<float> v(50.0f, 430.0f);
  for (int i = 0; i < count; ++i) {
    Keypoint& keypoint = frame.features.keypoints.emplace_back();
    keypoint.undistorted.x() = u(random);
    keypoint.undistorted.y() = v(random);
    keypoint.level = level;
    frame.features.descriptors.push_back({random(), random(), random(), random()});
    frame.features.depth.push_back(1.0f);
  }
  RebuildGrid(sensor, frame);
}

}  // namespace hullslam
