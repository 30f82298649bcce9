// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/map/map.h"
#include "map/keyframe_graph.h"

namespace hullslam {

inline Sensor BenchSensor() {
  Sensor sensor;
  sensor.camera = {.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};
  sensor.bounds = sensor.camera.UndistortedBounds();
  sensor.levels = ScaleLevels::Create(8, 1.2);
  sensor.close_depth = 3.2;
  return sensor;
}

// The frame with this number, of a camera at `cam_from_world` that sees `points` with 0.5 px of
// noise. Appends to `seen` the index of the point that each keypoint shows.
inline std::shared_ptr<const Frame> MakeBenchFrame(uint32_t number, const Sensor& sensor,
                                                   const Rigid3& cam_from_world,
                                                   const std::vector<Eigen::Vector3d>& points,
                                                   std::vector<size_t>& seen) {
  std::mt19937 random(number);
  std::normal_distribution<double> noise(0.0, 0.5);
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(number);
  FrameFeatures& features = frame->features;
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d in_cam = cam_from_world * points[i];
    const Eigen::Vector2d pixel = sensor.camera.Project(in_cam);
    if (!sensor.bounds.Contains(pixel)) {
      continue;
    }
    Keypoint& keypoint = features.keypoints.emplace_back();
    keypoint.undistorted = (pixel + Eigen::Vector2d(noise(random), noise(random))).cast<float>();
    features.descriptors.push_back({i, i * i, ~i, 7 * i});
    features.depth.push_back(static_cast<float>(in_cam.z()));
    seen.push_back(i);
  }
  return frame;
}

// Objects in front of the wall of MakeBenchMap, `spacing` m apart.
inline std::vector<Ellipsoid> BenchObjects(uint32_t keyframes, double spacing) {
  std::vector<Ellipsoid> ellipsoids;
  for (double x = -1.0; x < 0.1 * keyframes + 1.0; x += spacing) {
    ellipsoids.push_back(
        {{ExpSo3({0.3, x, 0.1}), {x, 0.4 * std::sin(5.0 * x), 1.6}}, {0.1, 0.08, 0.12}});
  }
  return ellipsoids;
}

// The detections of the objects that a camera sees, each with 16 tangents and 100 depth points.
// Appends to `seen` the index of the object of each detection.
inline std::vector<Detection> DetectBenchObjects(const Sensor& sensor, const Rigid3& cam_from_world,
                                                 const std::vector<Ellipsoid>& objects,
                                                 std::vector<size_t>& seen) {
  std::vector<Detection> detections;
  for (size_t i = 0; i < objects.size(); ++i) {
    const auto ellipse = ProjectEllipsoid(sensor.camera.Matrix(), cam_from_world, objects[i]);
    if (!ellipse.has_value() || !sensor.bounds.Contains(ellipse->center)) {
      continue;
    }
    Detection& detection = detections.emplace_back();
    for (int k = 0; k < 16; ++k) {
      const double angle = k * std::numbers::pi / 8.0;
      const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
      detection.lines.push_back(
          {{normal, -normal.dot(ellipse->center) - ellipse->HalfExtent(normal)}, false});
    }
    const Eigen::Vector3d center = cam_from_world * objects[i].world_from_object.translation;
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 100; ++k) {
      points.push_back(center + Eigen::Vector3d(0.05 * std::cos(k), 0.05 * std::sin(k), -0.1));
    }
    detection.points = points;
    seen.push_back(i);
  }
  return detections;
}

// The map of a camera that moves sideways along a wall of random points, with a keyframe every
// 10 cm. Each keyframe sees about 800 points, and each point is seen by about 25 keyframes. The
// positions of the landmarks have an error of 1 cm (standard deviation). Their ids increase along
// the wall, as they would in mapping.
inline Map MakeBenchMap(uint32_t keyframes, const Sensor& sensor,
                        const std::vector<Ellipsoid>& objects = {}) {
  constexpr double kSpacing = 0.1;  // m
  const double length = kSpacing * keyframes + 3.0;
  std::mt19937 random(1);
  const auto number = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Eigen::Vector3d> points(static_cast<size_t>(400.0 * length));
  for (Eigen::Vector3d& point : points) {
    point = {number(-1.5, length - 1.5), number(-0.8, 0.8), number(1.8, 2.2)};
  }
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.x() < b.x(); });
  std::normal_distribution<double> noise(0.0, 0.01);
  Map map;
  std::vector<LandmarkId> landmarks;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d error(noise(random), noise(random), noise(random));
    landmarks.push_back(map.AddLandmark(point + error, KeyframeId(0)));
  }
  for (const Ellipsoid& ellipsoid : objects) {
    ObjectLandmark& object = map.MutableObject(map.AddObject());
    object.state = ObjectState::kMapped;
    object.has_shape = true;
    object.ellipsoid = ellipsoid;
    object.start = ellipsoid;
    object.misfit_px = 4.0;
  }
  for (uint32_t k = 0; k < keyframes; ++k) {
    const Rigid3 cam_from_world(Eigen::Quaterniond::Identity(), {-kSpacing * k, 0.0, 0.0});
    std::vector<size_t> seen;
    std::vector<size_t> seen_objects;
    auto frame = std::make_shared<Frame>(*MakeBenchFrame(k, sensor, cam_from_world, points, seen));
    frame->detections = DetectBenchObjects(sensor, cam_from_world, objects, seen_objects);
    const KeyframeId id = map.AddKeyframe(std::move(frame), cam_from_world);
    for (uint32_t i = 0; i < seen_objects.size(); ++i) {
      map.AddObservation(ObjectId(static_cast<uint32_t>(seen_objects[i])), id, i);
    }
    for (uint32_t i = 0; i < seen.size(); ++i) {
      map.AddObservation(landmarks[seen[i]], id, i);
    }
    UpdateCovisibility(map, id);
  }
  return map;
}

}  // namespace hullslam
