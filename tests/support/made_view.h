// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/geometry/rigid3.h"
#include "view/view_model.h"

namespace hullslam {

// A mapped sphere of 0.2 m, 2 m in front of a camera at the origin, which sees it as a square.
inline ObjectResult MadeSphere(uint32_t id, const std::string& label) {
  ObjectResult object;
  object.id = ObjectId(id);
  object.state = ObjectState::kMapped;
  object.label = label;
  object.votes = {{label, 2.5}};
  object.ellipsoid = {Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}), {0.2, 0.2, 0.2}};
  object.fit.siou = 0.75;
  ObservationResult& view = object.observations.emplace_back();
  view.keyframe = KeyframeId(3);
  view.timestamp = 100.5;
  view.label = label;
  view.hull = {{22.0, 14.0}, {42.0, 14.0}, {42.0, 34.0}, {22.0, 34.0}};
  view.contour = view.hull;
  return object;
}

inline PinholeCamera MadeCamera() {
  PinholeCamera camera;
  camera.fx = camera.fy = 100.0;
  camera.cx = 32.0;
  camera.cy = 24.0;
  camera.width = 64;
  camera.height = 48;
  return camera;
}

// A model with something in every part: `count` poses along x, and as many landmarks.
inline ViewModel MadeView(size_t count, const std::string& label = "cup") {
  ViewModel model;
  model.title = "made";
  model.program = "rgbd_tum";
  model.up = -Eigen::Vector3d::UnitY();
  model.camera = MadeCamera();
  for (size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i);
    const StampedPose pose{100.0 + x, Rigid3(Eigen::Quaterniond::Identity(), {x, 0.0, 0.0})};
    model.trajectory.push_back(pose);
    model.groundtruth.push_back(pose);
    model.keyframes.ids.push_back(static_cast<uint32_t>(i));
    model.keyframes.poses.push_back(pose);
    model.errors.timestamps.push_back(pose.timestamp);
    model.errors.metres.push_back(0.01);
    model.landmarks.positions.emplace_back(static_cast<float>(x), 1.0f, 2.0f);
    model.landmarks.colours.push_back({255, 0, 1});
    model.landmarks.created.push_back(pose.timestamp);
  }
  model.landmarks.total = count;
  model.surface = {.positions = {{0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 1.0f}},
                   .colours = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}},
                   .triangles = {{0, 1, 2}}};
  model.objects.push_back({MadeSphere(7, label), {}, {}});
  model.edges.covisibility = {{0, 1}};
  model.pictures.push_back({.timestamp = 101.0,
                            .jpeg = "jpeg",
                            .width = 4,
                            .height = 3,
                            .outlines = {{ObjectId(7), label, {{0.04, 1.0}, {2.0, 2.0}}}},
                            .ellipses = {}});
  model.summary = {{"trajectory", {{"ate_rmse_m", 0.01}}}};
  return model;
}

}  // namespace hullslam
