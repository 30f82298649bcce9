// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geometry/polygon.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/map/map.h"
#include "map/keyframe_graph.h"

namespace hullslam {

inline Sensor MakeObjectSensor() {
  Sensor sensor;
  sensor.camera.fx = 520.0;
  sensor.camera.fy = 520.0;
  sensor.camera.cx = 320.0;
  sensor.camera.cy = 240.0;
  sensor.bounds = sensor.camera.UndistortedBounds();
  return sensor;
}

// A camera on a circle of radius `distance` about the world's origin, `height` above it (z is up),
// that looks at the origin.
inline Rigid3 CameraOnCircle(double angle, double distance, double height) {
  const Eigen::Vector3d center(distance * std::cos(angle), distance * std::sin(angle), height);
  const Eigen::Vector3d forward = -center.normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d cam_from_world;
  cam_from_world << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  const Eigen::Quaterniond rotation(cam_from_world);
  return {rotation, rotation * -center};
}

struct MadeObject {
  std::string label;
  Ellipsoid ellipsoid;
};

// Points of the surface that face the camera, m, camera frame.
inline std::vector<Eigen::Vector3d> VisibleSurface(const Ellipsoid& ellipsoid,
                                                   const Rigid3& cam_from_world) {
  std::vector<Eigen::Vector3d> points;
  const Rigid3 cam_from_object = cam_from_world * ellipsoid.world_from_object;
  constexpr int kCount = 300;
  for (int i = 0; i < kCount; ++i) {  // Fibonacci's lattice on the sphere
    const double z = 1.0 - (2.0 * i + 1.0) / kCount;
    const double angle = 2.0 * std::numbers::pi * i / std::numbers::phi;
    const double radius = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d unit(radius * std::cos(angle), radius * std::sin(angle), z);
    const Eigen::Vector3d point = cam_from_object * ellipsoid.half_axes.cwiseProduct(unit).eval();
    const Eigen::Vector3d normal =
        cam_from_object.rotation * unit.cwiseQuotient(ellipsoid.half_axes).eval();
    if (normal.dot(point) < 0.0) {
      points.push_back(point);
    }
  }
  return points;
}

// The detection of the object with an exact mask: 16 tangents, all of them two-sided.
inline Detection Detect(const MadeObject& object, const Sensor& sensor,
                        const Rigid3& cam_from_world) {
  const Ellipse ellipse =
      ProjectEllipsoid(sensor.camera.Matrix(), cam_from_world, object.ellipsoid).value();
  Detection detection;
  detection.label = object.label;
  detection.hull = ellipse.Polygon(64);
  detection.contour = detection.hull;
  detection.box = BoundingBox(detection.hull);
  for (int i = 0; i < 16; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 16;
    SilhouetteLine line;
    line.line.normal = {std::cos(angle), std::sin(angle)};
    line.line.offset = -line.line.normal.dot(ellipse.center) - ellipse.HalfExtent(line.line.normal);
    detection.lines.push_back(line);
  }
  detection.points = VisibleSurface(object.ellipsoid, cam_from_world);
  return detection;
}

// The depth image of these objects before a wall at this depth (m).
inline DepthGrid DepthOf(const std::vector<MadeObject>& objects, const Sensor& sensor,
                         const Rigid3& cam_from_world, double wall) {
  std::vector<uint16_t> samples;
  const int columns = DepthGrid::CountAlong(640);
  for (int i = 0; i < columns * DepthGrid::CountAlong(480); ++i) {
    const Eigen::Vector3d ray =
        sensor.camera.Unproject(DepthGrid::RawPixel(i % columns, i / columns), 1.0);
    double nearest = wall;
    for (const MadeObject& object : objects) {
      const Rigid3 object_from_cam = Inverse(cam_from_world * object.ellipsoid.world_from_object);
      const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
      const Eigen::Vector3d origin = object_from_cam.translation.cwiseQuotient(axes);
      const Eigen::Vector3d along = (object_from_cam.rotation * ray).cwiseQuotient(axes);
      const double b = origin.dot(along) / along.squaredNorm();
      const double root = b * b - (origin.squaredNorm() - 1.0) / along.squaredNorm();
      if (root > 0.0 && -b - std::sqrt(root) > 0.0) {
        nearest = std::min(nearest, -b - std::sqrt(root));
      }
    }
    samples.push_back(static_cast<uint16_t>(std::lround(1e3 * nearest)));
  }
  return DepthGrid(columns, std::move(samples));
}

// The line, which is a tangent of the ellipse, moved outwards by so many raw px.
inline Line2 MovedInImage(const Sensor& sensor, const Ellipse& ellipse, const Line2& tangent,
                          double pixels) {
  const Eigen::Vector2d normal = tangent.normal;
  const Eigen::Vector2d touching =
      ellipse.center + ellipse.shape * normal / ellipse.HalfExtent(normal);
  constexpr double kStep = 1e-3;
  const Eigen::Vector2d along = kStep * Eigen::Vector2d(-normal.y(), normal.x());
  const Eigen::Vector2d side =
      sensor.camera.Distort(touching + along) - sensor.camera.Distort(touching - along);
  const Eigen::Vector2d outwards =
      (sensor.camera.Distort(touching + kStep * normal) - sensor.camera.Distort(touching)) / kStep;
  const double share = std::abs(outwards.dot(Eigen::Vector2d(-side.y(), side.x()).normalized()));
  Line2 moved = tangent;
  moved.offset -= pixels / share;
  return moved;
}

// Adds a keyframe to the spanning tree of the map.
inline KeyframeId AddToTree(Map& map, std::shared_ptr<const Frame> frame,
                            const Rigid3& cam_from_world) {
  const KeyframeId added = map.AddKeyframe(std::move(frame), cam_from_world);
  if (added != KeyframeId(0)) {
    SetParent(map, added, KeyframeId(0));
  }
  return added;
}

// A keyframe without keypoints that sees these objects.
inline KeyframeId AddObserver(Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                              const std::vector<MadeObject>& objects) {
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(map.keyframes().NextId().value);
  for (const MadeObject& object : objects) {
    frame->detections.push_back(Detect(object, sensor, cam_from_world));
  }
  return AddToTree(map, std::move(frame), cam_from_world);
}

// The same, with the depth of the objects before a wall at 4 m.
inline KeyframeId AddObserverWithDepth(Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                                       const std::vector<MadeObject>& objects) {
  const KeyframeId keyframe = AddObserver(map, sensor, cam_from_world, objects);
  auto frame = std::make_shared<Frame>(*map.keyframes().At(keyframe).frame);
  frame->depth = DepthOf(objects, sensor, cam_from_world, 4.0);
  map.ReplaceFrame(keyframe, frame);
  return keyframe;
}

// A textured object, which keyframes without depth see together with landmarks on its surface.
class TexturedObject {
 public:
  // The landmarks lie on the side that `cam_from_world` sees.
  TexturedObject(MadeObject object, const Rigid3& cam_from_world, size_t landmarks)
      : object_(std::move(object)) {
    const std::vector<Eigen::Vector3d> visible = VisibleSurface(object_.ellipsoid, cam_from_world);
    for (size_t i = 0; i < landmarks; ++i) {
      points_.push_back(Inverse(cam_from_world) * visible[i * visible.size() / landmarks]);
    }
  }

  KeyframeId AddObserver(Map& map, const Sensor& sensor, const Rigid3& cam_from_world) {
    auto frame = std::make_shared<Frame>();
    frame->id = FrameId(map.keyframes().NextId().value);
    Detection& detection = frame->detections.emplace_back(Detect(object_, sensor, cam_from_world));
    detection.points.clear();
    for (uint32_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector2d pixel = sensor.camera.Project(cam_from_world * points_[i]);
      frame->features.keypoints.push_back({.undistorted = pixel.cast<float>()});
      detection.keypoints.push_back(i);
    }
    frame->features.descriptors.resize(points_.size());
    frame->features.depth.resize(points_.size(), 0.0f);
    const KeyframeId keyframe = AddToTree(map, std::move(frame), cam_from_world);
    for (uint32_t i = 0; i < points_.size(); ++i) {
      if (landmarks_.size() == i) {
        landmarks_.push_back(map.AddLandmark(points_[i], keyframe));
      }
      map.AddObservation(landmarks_[i], keyframe, i);
    }
    return keyframe;
  }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }  // world

 private:
  MadeObject object_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<LandmarkId> landmarks_;
};

inline MadeObject MakeObject(const std::string& label, const Eigen::Vector3d& center,
                             const Eigen::Vector3d& half_axes, double turn = 0.0) {
  MadeObject object;
  object.label = label;
  object.ellipsoid.world_from_object = {ExpSo3(Eigen::Vector3d(0.0, 0.0, turn)), center};
  object.ellipsoid.half_axes = half_axes;
  return object;
}

// Three things on a table that do not touch.
inline std::vector<MadeObject> MakeTable() {
  return {MakeObject("cup", {0.3, 0.1, 0.0}, {0.06, 0.05, 0.08}, 0.3),
          MakeObject("book", {-0.2, 0.2, 0.0}, {0.15, 0.10, 0.04}, 1.0),
          MakeObject("bottle", {0.0, -0.3, 0.05}, {0.05, 0.05, 0.14})};
}

}  // namespace hullslam
