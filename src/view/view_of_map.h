// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
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

// The mapped objects with the boxes that the scene of a run gives them (scene/make_scene.h).
std::map<ObjectId, SceneObject> BodiesOf(const Map& map, const PinholeCamera& camera,
                                         const std::optional<Trajectory>& groundtruth);

// The loops, and the covisibility edges with at least 100 shared landmarks, sorted: edges with
// fewer are not in the essential graph of ORB-SLAM2 (Mur-Artal and Tardos 2017), and they would
// cover the picture. If there are more than `most_covisible`, those with fewest shared landmarks
// are left out. With `island`, only the edges of keyframes of this island.
ViewEdges FindEdges(const Map& map, size_t most_covisible = std::numeric_limits<size_t>::max(),
                    std::optional<IslandId> island = std::nullopt);

// The time stamp of the keyframe that made a landmark, or of the first one that observes it if that
// was culled, s.
double CreationOf(const Map& map, const Landmark& landmark);

}  // namespace hullslam
