// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "map/keyframe_graph.h"
#include "objects/made_objects.h"
#include "report/object_results.h"
#include "scene/scene.h"

namespace hullslam {

// A map of mapped objects that twelve keyframes on a circle see, with exact masks. The world has z
// upwards.
inline Map MakeMapOf(const std::vector<MadeObject>& objects, const Sensor& sensor) {
  Map map;
  std::vector<ObjectId> ids;
  for (const MadeObject& object : objects) {
    ids.push_back(map.AddObject());
    ObjectLandmark& landmark = map.MutableObject(ids.back());
    landmark.state = ObjectState::kMapped;
    landmark.has_shape = true;
    landmark.ellipsoid = object.ellipsoid;
    landmark.start = object.ellipsoid;
  }
  for (uint32_t i = 0; i < 12; ++i) {
    const Rigid3 camera = CameraOnCircle(0.5 * i, 3.0, 1.5);
    auto frame = std::make_shared<Frame>();
    frame->id = FrameId(i);
    frame->timestamp = 10.0 + i;
    for (const MadeObject& object : objects) {
      frame->detections.push_back(Detect(object, sensor, camera));
    }
    const KeyframeId keyframe = map.AddKeyframe(frame, camera);
    for (uint32_t k = 0; k < ids.size(); ++k) {
      map.AddObservation(ids[k], keyframe, k);
    }
  }
  return map;
}

// An upright object: the centre of its underside and its half axes.
inline MadeObject Standing(const std::string& label, const Eigen::Vector3d& base,
                           const Eigen::Vector3d& half_axes) {
  const Eigen::Vector3d center = base + Eigen::Vector3d(0.0, 0.0, half_axes.z());
  return {label, {Rigid3(Eigen::Quaterniond::Identity(), center), half_axes}};
}

inline SceneObject SceneObjectOf(uint32_t id, const std::string& label,
                                 const Eigen::Vector3d& center, double radius) {
  SceneObject object;
  object.id = ObjectId(id);
  object.label = label;
  object.shares = {{label, 1.0}};
  object.ellipsoid = {Rigid3(Eigen::Quaterniond::Identity(), center),
                      Eigen::Vector3d::Constant(radius)};
  return object;
}

// A red cup on a book, another cup beside the book, a laptop far away, and a plant on the floor.
inline Scene MakeQueryScene() {
  Scene scene;
  scene.up = Eigen::Vector3d::UnitZ();
  scene.up_from = "ground truth";
  scene.objects = {SceneObjectOf(0, "cup", {0.0, 0.0, 0.1}, 0.05),
                   SceneObjectOf(2, "cup", {0.3, 0.0, 0.05}, 0.05),
                   SceneObjectOf(3, "book", {0.0, 0.0, 0.02}, 0.1),
                   SceneObjectOf(5, "laptop", {2.0, 0.0, 0.1}, 0.15),
                   SceneObjectOf(8, "potted plant", {0.4, 0.1, -0.5}, 0.2)};
  scene.objects[1].shares = {{"bowl", 0.2}, {"cup", 0.8}};
  scene.relations = {{ObjectId(0), RelationKind::kOn, ObjectId(3), {{"gap", 0.001}}},
                     {ObjectId(3), RelationKind::kSupports, ObjectId(0), {{"gap", 0.001}}},
                     {ObjectId(2), RelationKind::kBeside, ObjectId(3), {{"gap", 0.1}}},
                     {ObjectId(3), RelationKind::kBeside, ObjectId(2), {{"gap", 0.1}}}};
  scene.surfaces = {{-0.7, true, {ObjectId(8)}},
                    {0.0, false, {ObjectId(2), ObjectId(3), ObjectId(5)}}};
  return scene;
}

}  // namespace hullslam
