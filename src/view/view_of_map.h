// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "view/view_model.h"

namespace hullslam {

// Fills in what the map has and the files of a run do not have: landmarks with the times of their
// creation, keyframes with their ids, edges, and the reasons why the candidates among the objects
// of `model` are not mapped. Landmarks at infinity are left out (map/located_landmarks.h).
void AddMap(const Map& map, const Sensor& sensor, const ObjectOptions& options, ViewModel& model);

// The model of a map without a run. Its trajectory has the poses of the keyframes.
ViewModel ViewOfMap(const Map& map, const Sensor& sensor, const ObjectOptions& options);

// The time stamp of the keyframe that made a landmark, or of the first one that observes it if that
// was culled, s.
double CreationOf(const Map& map, const Landmark& landmark);

// A pixel that shows a landmark of the model.
struct LandmarkPixel {
  size_t landmark = 0;                              // index into ViewLandmarks::positions
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // raw px
};
struct KeyframePixels {
  double timestamp = 0.0;  // of the keyframe, s
  std::vector<LandmarkPixel> pixels;
};

// Where the landmarks that AddMap() adds are seen, each in one keyframe: in Landmark::reference, or
// in the first one that observes it. In order of time.
std::vector<KeyframePixels> FindLandmarkPixels(const Map& map, const Sensor& sensor);

}  // namespace hullslam
