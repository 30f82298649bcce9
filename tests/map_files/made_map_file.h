// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hullslam/map_files/map_file.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"

// Maps and settings for tests of map files.
namespace hullslam {

inline MapSettings MadeSettings() {
  MapSettings settings;
  settings.camera = {
      .fx = 500.0, .fy = 501.0, .cx = 319.5, .cy = 239.5, .width = 640, .height = 480};
  return settings;
}

// A detection in which no field has its default value.
inline Detection FullDetection() {
  Detection detection;
  detection.label = "cup";
  detection.score = 0.8125;
  detection.contour = std::vector<Eigen::Vector2d>{{10.5, 20.25}, {30.0, 21.0}, {29.0, 40.0}};
  detection.hull = {{10.5, 20.25}, {30.1, 21.2}, {29.3, 40.4}};
  detection.box = Eigen::AlignedBox2d(Eigen::Vector2d(10.5, 20.25), Eigen::Vector2d(30.1, 40.4));
  detection.primitive = ObjectPrimitive::kConic;
  detection.lines = {{.line = {.normal = {0.6, -0.8}, .offset = 12.5}, .is_one_sided = true},
                     {.line = {.normal = {0.0, 1.0}, .offset = -40.4}}};
  detection.right_lines = {{.line = {.normal = {0.8, 0.6}, .offset = -3.5}, .is_one_sided = true}};
  detection.ellipse = Ellipse{.center = {20.0, 30.0},
                              .shape = (Eigen::Matrix2d() << 90.0, 3.0, 3.0, 80.0).finished()};
  detection.is_cut = true;
  detection.is_box = true;
  detection.points = std::vector<Eigen::Vector3d>{{0.25, 0.5, 1.5}, {0.125, 0.75, 2.0}};
  detection.keypoints = {1, 3};
  return detection;
}

inline std::shared_ptr<Frame> FullFrame(uint32_t id, double timestamp) {
  constexpr size_t kKeypoints = 4;
  std::shared_ptr<Frame> frame = MakeFrame(id, kKeypoints, 2);
  frame->timestamp = timestamp;
  for (size_t i = 0; i < kKeypoints; ++i) {
    frame->features.keypoints[i].angle = 0.5f * static_cast<float>(i);
    frame->features.keypoints[i].level = static_cast<int>(i);
    frame->features.descriptors[i] = {i, ~i, 7 * i, uint64_t{1} << (60 - i)};
  }
  frame->detections = {FullDetection()};
  return frame;
}

// A map with two keyframes, a culled one, two landmarks, a free slot and an object.
inline Map SmallMap() {
  Map map;
  map.BeginSession({"desk", FrameId(0)});
  const KeyframeId a = map.AddKeyframe(FullFrame(0, 10.5), {});
  const KeyframeId b = map.AddKeyframe(FullFrame(4, 11.5), {{0.8, 0.0, 0.6, 0.0}, {1, 2, 3}});
  map.BeginSession({"desk again", FrameId(7)});
  const KeyframeId c = map.AddKeyframe(FullFrame(9, 3.5), {});
  const std::vector<LandmarkId> landmarks = Share(map, {a, b, c}, 3);
  map.EraseLandmark(landmarks[1]);
  for (const KeyframeId id : {a, b, c}) {
    UpdateCovisibility(map, id);
  }
  map.AddLoop(a, c);
  map.CullKeyframe(b);
  map.EraseObject(map.AddObject());
  const ObjectId object = map.AddObject();
  map.AddObservation(object, a, 0);
  ObjectLandmark& cup = map.MutableObject(object);
  cup.state = ObjectState::kMapped;
  cup.has_shape = true;
  cup.ellipsoid.half_axes = {0.04, 0.05, 0.06};
  cup.start.half_axes = {0.05, 0.05, 0.05};
  cup.shaped_views = 3;
  cup.misfit_px = 1.25;
  cup.compensated_px = 0.75;
  cup.misfit_samples = {{.normal = {0.0, 0.6, 0.8}, .excess = -0.01, .keyframe = a}};
  cup.visible = 5;
  cup.found = 4;
  map.CountCorrection();
  return map;
}

// Two islands of two keyframes each, which see the same landmarks within the island.
inline Map MapOfTwoIslands() {
  Map map;
  map.BeginSession({"rooms", FrameId(0)});
  for (int i = 0; i < 2; ++i) {
    const IslandId island = map.BeginIsland();
    std::vector<KeyframeId> ids;
    for (int k = 0; k < 2; ++k) {
      const uint32_t number = map.keyframes().NextId().value;
      ids.push_back(map.AddKeyframe(FullFrame(number, 0.5 * number), {}, island));
    }
    Share(map, ids, 3);
    UpdateCovisibility(map, ids.back());
  }
  return map;
}

}  // namespace hullslam
