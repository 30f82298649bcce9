// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "util/hash.h"

namespace hullslam {

inline void AddKeypoint(const Eigen::Vector2d& pixel, double depth, int level, float angle,
                        const Descriptor& descriptor, FrameFeatures& features) {
  Keypoint& keypoint = features.keypoints.emplace_back();
  keypoint.undistorted = pixel.cast<float>();
  keypoint.angle = angle;
  keypoint.level = level;
  features.descriptors.push_back(descriptor);
  features.depth.push_back(static_cast<float>(depth));
}

// Adds keypoints that are those of no point.
inline void AddClutter(int count, const Sensor& sensor, std::mt19937_64& random,
                       FrameFeatures& features) {
  std::uniform_real_distribution<double> share(0.02, 0.98);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d pixel(sensor.bounds.max_x * share(random),
                                sensor.bounds.max_y * share(random));
    AddKeypoint(pixel, 2.0 + share(random), static_cast<int>(random() % 8),
                static_cast<float>(6.2 * share(random)), {random(), random(), random(), random()},
                features);
  }
}

// A long wall of points with objects in front of it, and the frames of a camera that walks along it
// at 1.2 m/s, looks at it, and turns back at the ends. Frames are made without images. Every frame
// also has keypoints that no other frame sees, so that landmarks are made and soon removed, as in
// real images. Masks are like those of a network: one object in five is missed, one in eight has
// another class, one in ten is found twice, and each frame has a mask that shows no object. The
// same frame always has the same bits.
class MadeCorridor {
 public:
  // `length_in_frames` is the number of frames of one way.
  MadeCorridor(size_t length_in_frames, const Sensor& sensor)
      : sensor_(sensor), length_in_frames_(static_cast<uint32_t>(length_in_frames)) {
    constexpr double kPointsPerMetre = 160.0;
    constexpr double kObjectSpacing = 0.4;  // m
    std::mt19937_64 random(1);
    const double length = kStep * static_cast<double>(length_in_frames) + 4.0;
    const auto number = [&random](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (size_t i = 0; i < static_cast<size_t>(kPointsPerMetre * length); ++i) {
      AddPoint({number(-2.0, length - 2.0), number(-1.4, 1.4), number(2.6, 3.4)}, random);
    }
    for (double x = -1.0; x < length - 3.0; x += kObjectSpacing) {
      const Eigen::Vector3d center(x, number(-0.8, 0.8), number(2.0, 2.3));
      const Eigen::Vector3d half_axes(number(0.08, 0.15), number(0.08, 0.15), number(0.08, 0.15));
      objects_.push_back({{ExpSo3({0.3, x, 0.1}), center}, half_axes});
      for (int i = 0; i < 10; ++i) {
        AddPoint(FrontPoint(objects_.back(), number(-1.0, 1.0), number(-1.0, 1.0)), random);
      }
    }
    std::sort(points_.begin(), points_.end(),
              [](const Point& a, const Point& b) { return a.position.x() < b.position.x(); });
  }

  // The frame with this number.
  std::unique_ptr<Frame> MakeFrame(uint32_t number) const {
    std::mt19937_64 random(HashSeed(1, number, "corridor"));
    const uint32_t on_way = number % (2 * length_in_frames_);
    const Rigid3 cam_from_world =
        CamFromWorld(on_way < length_in_frames_ ? on_way : 2 * length_in_frames_ - on_way);
    auto frame = std::make_unique<Frame>();
    frame->id = FrameId(number);
    frame->timestamp = number / sensor_.frames_per_second;
    AddPoints(cam_from_world, random, frame->features);
    AddClutter(kClutter, sensor_, random, frame->features);
    frame->features.keypoints.shrink_to_fit();
    frame->features.descriptors.shrink_to_fit();
    frame->features.depth.shrink_to_fit();
    const PinholeCamera::Bounds& bounds = sensor_.bounds;
    frame->features.grid = FeatureGrid(frame->features.keypoints,
                                       Eigen::Vector2d(bounds.min_x, bounds.min_y).cast<float>(),
                                       Eigen::Vector2d(bounds.max_x, bounds.max_y).cast<float>());
    AddDetections(cam_from_world, random, *frame);
    frame->detections.shrink_to_fit();
    return frame;
  }

  // The outline of a detection whose mask is the ellipse.
  static void Outline(const Ellipse& ellipse, Detection& detection) {
    detection.hull = ellipse.Polygon(64);
    detection.contour = detection.hull;
    detection.box = ellipse.Bounds();
    for (int k = 0; k < 16; ++k) {
      const double angle = k * std::numbers::pi / 8.0;
      const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
      detection.lines.push_back(
          {{normal, -normal.dot(ellipse.center) - ellipse.HalfExtent(normal)}, false});
    }
  }

  // Lists the keypoints that are on the object.
  static void AddKeypointsIn(const Ellipse& ellipse, const Ellipsoid& object,
                             const Rigid3& cam_from_world, const FrameFeatures& features,
                             Detection& detection) {
    const double depth = (cam_from_world * object.world_from_object.translation).z();
    const Eigen::Matrix2d inverse_shape = ellipse.shape.inverse();
    for (uint32_t i = 0; i < features.size(); ++i) {
      const Eigen::Vector2d offset =
          features.keypoints[i].undistorted.cast<double>() - ellipse.center;
      if (offset.dot(inverse_shape * offset) <= 1.0 &&
          std::abs(static_cast<double>(features.depth[i]) - depth) < 0.2) {
        detection.keypoints.push_back(i);
      }
    }
  }

 private:
  static constexpr double kStep = 0.04;  // m per frame
  static constexpr double kReach = 3.0;  // m along the wall that may be in the image
  static constexpr int kClutter = 300;   // keypoints per frame

  struct Point {
    Eigen::Vector3d position;  // m, world frame
    Descriptor descriptor{};
    float angle = 0.0f;         // rad
    double max_distance = 0.0;  // m, the largest distance at which it is seen at level 0
  };

  void AddPoint(const Eigen::Vector3d& position, std::mt19937_64& random) {
    Point& point = points_.emplace_back();
    point.position = position;
    point.descriptor = {random(), random(), random(), random()};
    point.angle = static_cast<float>(random() % 6283) * 1e-3f;
    point.max_distance = 2.0 + 1e-3 * static_cast<double>(random() % 4000);
  }

  // A point on the side of an object that faces the camera. u and v from -1 to 1.
  static Eigen::Vector3d FrontPoint(const Ellipsoid& object, double u, double v) {
    const Eigen::Vector3d outwards = Eigen::Vector3d(u, v, -1.0).normalized();
    const Eigen::Vector3d in_object = object.world_from_object.rotation.conjugate() * outwards;
    return object.world_from_object * object.half_axes.cwiseProduct(in_object).eval();
  }

  static Rigid3 CamFromWorld(uint32_t number) {
    const double phase = 2.0 * std::numbers::pi * number / 180.0;
    const Eigen::Vector3d center(kStep * number, 0.1 * std::sin(phase), 0.15 * std::cos(phase));
    const Eigen::Quaterniond rotation =
        ExpSo3({0.03 * std::cos(phase), 0.05 * std::sin(phase), 0.0});
    return {rotation, -(rotation * center)};
  }

  void AddPoints(const Rigid3& cam_from_world, std::mt19937_64& random,
                 FrameFeatures& features) const {
    const double x = Inverse(cam_from_world).translation.x();
    const auto before = [](const Point& point, double limit) { return point.position.x() < limit; };
    const auto first = std::lower_bound(points_.begin(), points_.end(), x - kReach, before);
    const auto last = std::lower_bound(first, points_.end(), x + kReach, before);
    std::normal_distribution<double> noise(0.0, 0.4);
    for (auto point = first; point != last; ++point) {
      const Eigen::Vector3d in_cam = cam_from_world * point->position;
      const Eigen::Vector2d pixel = sensor_.camera.Project(in_cam);
      if (sensor_.bounds.Contains(pixel)) {
        const int level = sensor_.levels.PredictLevel(in_cam.norm(), point->max_distance);
        const double scale = static_cast<double>(sensor_.levels.scale[static_cast<size_t>(level)]);
        Descriptor descriptor = point->descriptor;
        descriptor[random() % 4] ^= uint64_t{1} << (random() % 64);
        const Eigen::Vector2d error(scale * noise(random), scale * noise(random));
        AddKeypoint(pixel + error, in_cam.z() * (1.0 + 2e-3 * noise(random)), level, point->angle,
                    descriptor, features);
      }
    }
  }

  void AddDetections(const Rigid3& cam_from_world, std::mt19937_64& random, Frame& frame) const {
    const Eigen::Vector3d center = Inverse(cam_from_world).translation;
    for (size_t i = 0; i < objects_.size(); ++i) {
      if (std::abs(objects_[i].world_from_object.translation.x() - center.x()) > kReach) {
        continue;
      }
      const bool is_found = random() % 5 != 0;
      const bool is_mistaken = random() % 8 == 0;
      const bool is_doubled = random() % 10 == 0;
      if (is_found) {
        AddDetection(objects_[i], is_mistaken ? i + 1 : i, cam_from_world, frame);
      }
      if (is_found && is_doubled) {
        AddDetection(objects_[i], i + 2, cam_from_world, frame);
      }
    }
    std::uniform_real_distribution<double> offset(-0.8, 0.8);
    const Eigen::Vector3d nowhere = center + Eigen::Vector3d(offset(random), offset(random), 2.0);
    AddDetection({{Eigen::Quaterniond::Identity(), nowhere}, Eigen::Vector3d::Constant(0.1)},
                 random(), cam_from_world, frame);
  }

  // Nothing if the object is not wholly in the image.
  void AddDetection(const Ellipsoid& object, size_t label, const Rigid3& cam_from_world,
                    Frame& frame) const {
    constexpr std::array kLabels = {"cup", "book", "bottle", "plant", "bowl"};
    const auto ellipse = ProjectEllipsoid(sensor_.camera.Matrix(), cam_from_world, object);
    if (ellipse && sensor_.bounds.Contains(ellipse->Bounds().min()) &&
        sensor_.bounds.Contains(ellipse->Bounds().max())) {
      Detection& detection = frame.detections.emplace_back();
      detection.label = kLabels[label % kLabels.size()];
      Outline(*ellipse, detection);
      AddPointsOn(object, cam_from_world, detection);
      AddKeypointsIn(*ellipse, object, cam_from_world, frame.features, detection);
    }
  }

  static void AddPointsOn(const Ellipsoid& object, const Rigid3& cam_from_world,
                          Detection& detection) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 100; ++i) {
      points.push_back(cam_from_world * FrontPoint(object, i % 10 / 4.5 - 1.0, i / 10 / 4.5 - 1.0));
    }
    detection.points = points;
  }

  const Sensor& sensor_;
  const uint32_t length_in_frames_;
  std::vector<Point> points_;  // by x
  std::vector<Ellipsoid> objects_;
};

}  // namespace hullslam
