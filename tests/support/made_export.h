// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>
#include <string>

#include "exports/export_input.h"

namespace hullslam {

// A camera with distortion that bends the borders of the image inwards.
inline PinholeCamera DistortedCamera() {
  PinholeCamera camera;
  camera.fx = 130.0;
  camera.fy = 128.0;
  camera.cx = 79.0;
  camera.cy = 61.0;
  camera.k1 = 0.2;
  camera.k2 = -0.5;
  camera.p1 = 0.002;
  camera.width = 160;
  camera.height = 120;
  return camera;
}

inline SceneObject MadeSceneObject(uint32_t id, const std::string& label) {
  SceneObject object;
  object.id = ObjectId(id);
  object.label = label;
  object.shares = {{label, 1.0}};
  object.ellipsoid = {Rigid3(ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {0.1 * id, 0.0, 2.0}),
                      {0.1, 0.2, 0.3}};
  object.observations = 5;
  object.quality = 0.5;
  return object;
}

// Three poses along x, two points, a cup with an upright box and a book without one.
inline ExportModel MadeExportModel() {
  ExportModel model;
  model.camera = DistortedCamera();
  for (int i = 0; i < 3; ++i) {
    model.trajectory.push_back(
        {100.5 + i, Rigid3(Eigen::Quaterniond::Identity(), {0.5 * i, 0.0, 0.0})});
  }
  model.keyframes = {model.trajectory.front(), model.trajectory.back()};
  model.points = {{{1.0, -2.0, 3.0}, {255, 0, 128}}, {{0.0, 0.5, 2.0}, {0, 64, 255}}};
  model.scene.up = Eigen::Vector3d(0.0, -1.0, 0.0);
  model.scene.objects = {MadeSceneObject(3, "cup"), MadeSceneObject(7, "book")};
  model.scene.objects[0].box =
      UprightBox{Rigid3(Eigen::Quaterniond::Identity(), {0.3, 0.1, 2.0}), {0.5, 0.25, 0.125}};
  return model;
}

}  // namespace hullslam
