// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "objects/made_objects.h"

namespace hullslam {

// Seven things around the origin, of which no two have the same size. There are two cups.
inline std::vector<MadeObject> MakeRoom() {
  return {MakeObject("cup", {0.35, 0.1, 0.0}, {0.06, 0.05, 0.08}, 0.3),
          MakeObject("cup", {-0.3, -0.25, 0.1}, {0.05, 0.05, 0.06}),
          MakeObject("book", {-0.3, 0.3, 0.0}, {0.15, 0.10, 0.04}, 1.0),
          MakeObject("bottle", {0.05, -0.4, 0.05}, {0.05, 0.05, 0.14}),
          MakeObject("ball", {0.0, 0.05, 0.3}, {0.11, 0.11, 0.11}),
          MakeObject("plant", {0.3, 0.5, 0.15}, {0.1, 0.12, 0.2}),
          MakeObject("mouse", {0.1, 0.3, -0.1}, {0.06, 0.035, 0.02}, 0.7)};
}

// The same things, moved by a motion.
inline std::vector<MadeObject> Moved(const Rigid3& motion, std::vector<MadeObject> objects) {
  for (MadeObject& object : objects) {
    object.ellipsoid = motion * object.ellipsoid;
  }
  return objects;
}

// Adds mapped objects that a keyframe on a circle has seen. `motion` moves the objects and the
// keyframe together.
inline void AddRoom(Map& map, const Sensor& sensor, const std::vector<MadeObject>& objects,
                    const Rigid3& motion = {}) {
  const Rigid3 camera = CameraOnCircle(0.2, 2.0, 0.8) * Inverse(motion);
  const KeyframeId keyframe = AddObserver(map, sensor, camera, objects);
  for (uint32_t i = 0; i < objects.size(); ++i) {
    const ObjectId id = map.AddObject();
    map.AddObservation(id, keyframe, i);
    ObjectLandmark& object = map.MutableObject(id);
    object.state = ObjectState::kMapped;
    object.has_shape = true;
    object.ellipsoid = objects[i].ellipsoid;
  }
}

// A frame that shows these objects. The depth points of each are moved by a random vector with this
// standard deviation (m) along each axis.
inline Frame SeeRoom(const Sensor& sensor, const std::vector<MadeObject>& objects,
                     const Rigid3& cam_from_world, double noise = 0.0) {
  Frame frame;
  frame.id = FrameId(100);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (const MadeObject& object : objects) {
    Detection detection = Detect(object, sensor, cam_from_world);
    Eigen::Vector3d offset;
    for (double& value : offset) {
      value = noise * normal(random);
    }
    std::vector<Eigen::Vector3d> points = detection.points.Unpack();
    for (Eigen::Vector3d& point : points) {
      point += offset;
    }
    detection.points = points;
    frame.detections.push_back(std::move(detection));
  }
  return frame;
}

// The same frame from a camera without depth.
inline Frame WithoutDepth(Frame frame) {
  for (Detection& detection : frame.detections) {
    detection.points.clear();
  }
  return frame;
}

}  // namespace hullslam
