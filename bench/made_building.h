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
#include <string>
#include <utility>
#include <vector>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "made_corridor.h"
#include "util/hash.h"

namespace hullslam {

// Twenty rooms, 5 m wide, in a ring, and a robot that patrols them for hours: a lap of 82 m takes
// two and a half minutes. It looks at the outer wall, on a course and in a direction that are never
// quite those of an earlier lap, and turns back every 17 minutes. The rooms 5 and 15 are exact
// copies of each other. In each room there are three objects; one object in four is moved to
// another place of its room from time to time. Four of ten points look different by day and by
// lamp. Every 200 s there are no images for a while, for 0.2 to 5 s in turn, while the robot goes
// on. In the middle it stands still for a tenth of the time. Frames are made without images.
// Detections fail as in MadeCorridor. The same seed and time give the same bits.
class MadeBuilding {
 public:
  static constexpr size_t kRooms = 20;
  static constexpr double kGapEvery = 200.0;  // s

  // The robot works for `seconds`. `vocabulary` may be null. If nothing changes, the objects stay
  // where they are and it is always day. With another `seed` it is another building, which has
  // nothing in common with the first one but the kinds of its objects. With more than two `lights`
  // they follow each other, and the points look different in each.
  MadeBuilding(double seconds, const Sensor& sensor, const Vocabulary* vocabulary,
               bool is_unchanged = false, uint64_t seed = 100, size_t lights = 2)
      : sensor_(sensor),
        vocabulary_(vocabulary),
        seed_(seed),
        lights_(is_unchanged ? 1 : lights),
        seconds_(seconds),
        day_(is_unchanged ? 1e9 : std::min(3600.0, seconds / 3.0)),
        move_every_(is_unchanged ? 1e9 : std::min(600.0, seconds / 8.0)) {
    for (size_t room = 0; room < kRooms; ++room) {
      AddRoom(room);
    }
    std::sort(points_.begin(), points_.end(),
              [](const Point& a, const Point& b) { return a.along < b.along; });
  }

  // Whether there is an image at this time (s).
  bool HasImage(double time) const {
    constexpr std::array kGaps = {0.2, 0.5, 1.0, 2.0, 5.0};
    const auto gap = static_cast<size_t>(time / kGapEvery);
    return time < kGapEvery || time - static_cast<double>(gap) * kGapEvery > kGaps[gap % 5];
  }

  // The true pose of the camera, which does not depend on what was asked before.
  Rigid3 CamFromWorld(double time) const {
    constexpr double kTurnEvery = 1020.0;  // s
    constexpr double kSpeed = 0.55;        // m/s
    const double still = 0.1 * seconds_;
    const double begin = 0.5 * seconds_;
    const double walked = time < begin ? time : std::max(begin, time - still);
    const double phase = std::fmod(walked, 2.0 * kTurnEvery);
    const double forth = phase < kTurnEvery ? phase : 2.0 * kTurnEvery - phase;
    const double angle = kSpeed * forth / kCourse;
    const double yaw = angle + 0.15 * std::sin(walked / 7.3) + 0.1 * std::sin(walked / 31.7);
    const double radius = kCourse + 0.2 * std::sin(walked / 19.1) + 0.1 * std::sin(walked / 5.3);
    const Eigen::Vector3d center(radius * std::sin(angle), 0.03 * std::sin(walked / 3.1),
                                 radius * std::cos(angle));
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitY()));
    return {rotation, -(rotation * center)};
  }

  // The share of the columns of the image at this time that show the wall of room 5 or 15. If it is
  // 1, nothing tells which of the two it is.
  double ShareOfTwin(double time) const {
    constexpr int kColumns = 40;
    const Rigid3 cam_from_world = CamFromWorld(time);
    const auto room_at = [&](double column) {
      const double slope = (column - sensor_.camera.cx) / sensor_.camera.fx;
      const Eigen::Vector3d at_wall = Inverse(cam_from_world) * (WallDepth(cam_from_world, slope) *
                                                                 Eigen::Vector3d(slope, 0.0, 1.0));
      const double angle = std::atan2(at_wall.x(), at_wall.z()) / (2.0 * std::numbers::pi);
      return static_cast<size_t>(kRooms * (angle < 0.0 ? angle + 1.0 : angle));
    };
    int of_twin = 0;
    for (int i = 0; i <= kColumns; ++i) {
      const size_t room = room_at(
          std::lerp(sensor_.bounds.min_x, sensor_.bounds.max_x, static_cast<double>(i) / kColumns));
      of_twin += room == 5 || room == 15 ? 1 : 0;
    }
    return static_cast<double>(of_twin) / (kColumns + 1);
  }

  // The image at this time, whose random errors follow from its number.
  std::unique_ptr<Frame> MakeFrame(double time, uint32_t number) const {
    std::mt19937_64 random(HashSeed(1, number, "building"));
    const Rigid3 cam_from_world = CamFromWorld(time);
    auto frame = std::make_unique<Frame>();
    frame->timestamp = time;
    const std::vector<Seen> seen = Look(time, cam_from_world);
    frame->depth = MakeGrid(cam_from_world, seen);
    AddPoints(time, cam_from_world, seen, random, frame->features);
    constexpr int kClutter = 60;
    AddClutter(kClutter, sensor_, random, frame->features);
    const PinholeCamera::Bounds& bounds = sensor_.bounds;
    frame->features.grid = FeatureGrid(frame->features.keypoints,
                                       Eigen::Vector2d(bounds.min_x, bounds.min_y).cast<float>(),
                                       Eigen::Vector2d(bounds.max_x, bounds.max_y).cast<float>());
    if (vocabulary_ != nullptr) {
      frame->words = vocabulary_->WordsOf(frame->features.descriptors);
    }
    AddDetections(cam_from_world, seen, random, *frame);
    return frame;
  }

  // An object as it is at a time.
  struct Truth {
    Ellipsoid ellipsoid;
    std::string label;
  };
  std::vector<Truth> ObjectsAt(double time) const {
    std::vector<Truth> truth;
    for (size_t i = 0; i < objects_.size(); ++i) {
      truth.push_back({EllipsoidAt(i, time), LabelOf(objects_[i].label)});
    }
    return truth;
  }

  // What a descriptor shows at a time: the point next to a position, and in which light.
  struct Shown {
    size_t point = SIZE_MAX;  // SIZE_MAX: no point
    size_t light = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
  };
  Shown WhatShows(const Descriptor& descriptor, const Eigen::Vector3d& near, double time) const {
    constexpr int kMostBits = 8;  // that noise changes
    Shown shown;
    for (size_t i = 0; i < points_.size(); ++i) {
      const Point& point = points_[i];
      size_t light = 0;
      while (light < lights_ && HammingDistance(descriptor, LookOf(point, light)) > kMostBits) {
        ++light;
      }
      if (light == lights_) {
        continue;
      }
      const Eigen::Vector3d position = point.object == SIZE_MAX
                                           ? OnRing(point.along, point.height, kWall)
                                           : FrontPoint(EllipsoidAt(point.object, time),
                                                        point.on_object.x(), point.on_object.y());
      if (shown.point == SIZE_MAX || (position - near).norm() < (shown.position - near).norm()) {
        shown = {i, light, position};  // two rooms are equal
      }
    }
    return shown;
  }

 private:
  static constexpr double kCourse = 13.0;  // m, radius of the course
  static constexpr double kWall = 5.0 * kRooms / (2.0 * std::numbers::pi);  // m, of the wall
  static constexpr double kReach = 2.9;  // m along the wall that may be in the image
  static constexpr size_t kSlots = 3;    // places of an object

  struct Point {
    double along = 0.0;   // m along the wall
    double height = 0.0;  // m, downwards
    Descriptor descriptor{};
    bool changes = false;                                 // with the light
    float angle = 0.0f;                                   // rad
    double max_distance = 0.0;                            // m, at which it is seen at level 0
    size_t object = SIZE_MAX;                             // on which it is; SIZE_MAX: the wall
    Eigen::Vector2d on_object = Eigen::Vector2d::Zero();  // -1 to 1
  };
  struct Object {
    std::array<Eigen::Vector3d, kSlots> places;  // along the wall, height, radius; m
    Eigen::Vector3d half_axes = Eigen::Vector3d::Zero();
    size_t label = 0;
    bool is_movable = false;
  };
  struct Seen {
    size_t object = 0;
    Ellipsoid ellipsoid;
    Ellipse ellipse;
    double depth = 0.0;  // m, of its centre
  };

  static std::string LabelOf(size_t label) {
    constexpr std::array kLabels = {"cup", "book", "bottle", "plant", "bowl"};
    return kLabels[label % kLabels.size()];
  }

  void AddRoom(size_t room) {
    std::mt19937_64 random(seed_ + (room == 15 ? 5 : room));
    const auto number = [&random](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double begin = 5.0 * static_cast<double>(room);
    const auto make_point = [&] {
      Point& point = points_.emplace_back();
      point.descriptor = {random(), random(), random(), random()};
      random.discard(4);
      point.changes = random() % 10 < 4;
      point.angle = static_cast<float>(random() % 6283) * 1e-3f;
      point.max_distance = 2.0 + 1e-3 * static_cast<double>(random() % 4000);
      return &point;
    };
    constexpr int kPoints = 300;
    for (int i = 0; i < kPoints; ++i) {
      Point* const point = make_point();
      point->along = begin + number(0.0, 5.0);
      point->height = number(-1.4, 1.4);
    }
    for (size_t i = 0; i < 3; ++i) {
      Object& object = objects_.emplace_back();
      for (size_t slot = 0; slot < kSlots; ++slot) {
        object.places[slot] = {
            begin + 0.4 + 1.65 * static_cast<double>(i) + 0.45 * static_cast<double>(slot),
            number(-0.7, 0.7), kWall - number(0.5, 0.8)};
      }
      object.half_axes = {number(0.08, 0.15), number(0.08, 0.15), number(0.08, 0.15)};
      object.label = random() % 5;
      object.is_movable = i == 0 && room % 4 != 3 && room != 5;
      for (int k = 0; k < 10; ++k) {
        Point* const point = make_point();
        point->along = object.places[1].x();
        point->object = objects_.size() - 1;
        point->on_object = {number(-1.0, 1.0), number(-1.0, 1.0)};
      }
    }
  }

  static Eigen::Vector3d OnRing(double along, double height, double radius) {
    const double angle = along / kWall;
    return {radius * std::sin(angle), height, radius * std::cos(angle)};
  }

  Ellipsoid EllipsoidAt(size_t index, double time) const {
    const Object& object = objects_[index];
    // One object after the other is moved, the last ones at two of these times before the end.
    const auto moves =
        static_cast<size_t>(time / move_every_ + 2.0 + static_cast<double>(index) / 60.0);
    const size_t slot = object.is_movable ? moves / 4 % kSlots : 1;
    const Eigen::Vector3d& place = object.places[slot];
    return {
        {ExpSo3({0.3, static_cast<double>(index), 0.1}), OnRing(place.x(), place.y(), place.z())},
        object.half_axes};
  }

  size_t LightAt(double time) const { return static_cast<size_t>(time / (0.5 * day_)) % lights_; }
  static Descriptor LookOf(const Point& point, size_t light) {
    Descriptor descriptor = point.descriptor;
    if (point.changes && light > 0) {
      for (uint64_t& word : descriptor) {
        word ^= HashSeed(word, static_cast<uint32_t>(light), "light");
      }
    }
    return descriptor;
  }

  // The way along the wall from the camera's own place, to both sides.
  static double Beside(double along, double camera) {
    constexpr double kLength = 5.0 * kRooms;
    return std::remainder(along - camera, kLength);
  }

  static double AlongOf(const Rigid3& cam_from_world) {
    const Eigen::Vector3d forward = cam_from_world.rotation.conjugate() * Eigen::Vector3d(0, 0, 1);
    const Eigen::Vector3d at_wall =
        Inverse(cam_from_world).translation + (kWall - kCourse) * forward;
    const double angle = std::atan2(at_wall.x(), at_wall.z());
    return kWall * (angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle);
  }

  // The objects in the image.
  std::vector<Seen> Look(double time, const Rigid3& cam_from_world) const {
    std::vector<Seen> seen;
    const double camera = AlongOf(cam_from_world);
    for (size_t i = 0; i < objects_.size(); ++i) {
      if (std::abs(Beside(objects_[i].places[1].x(), camera)) > kReach) {
        continue;
      }
      const Ellipsoid ellipsoid = EllipsoidAt(i, time);
      const auto ellipse = ProjectEllipsoid(sensor_.camera.Matrix(), cam_from_world, ellipsoid);
      if (ellipse && sensor_.bounds.Contains(ellipse->center)) {
        const double depth = (cam_from_world * ellipsoid.world_from_object.translation).z();
        seen.push_back({i, ellipsoid, *ellipse, depth});
      }
    }
    return seen;
  }

  // Depth of the wall where this column sees it, m.
  static double WallDepth(const Rigid3& cam_from_world, double slope) {
    const Rigid3 world_from_cam = Inverse(cam_from_world);
    const Eigen::Vector3d ray = world_from_cam.rotation * Eigen::Vector3d(slope, 0.0, 1.0);
    const Eigen::Vector2d origin(world_from_cam.translation.x(), world_from_cam.translation.z());
    const Eigen::Vector2d direction(ray.x(), ray.z());
    const double a = direction.squaredNorm();
    const double b = origin.dot(direction);
    const double c = origin.squaredNorm() - kWall * kWall;
    return (-b + std::sqrt(b * b - a * c)) / a;
  }

  DepthGrid MakeGrid(const Rigid3& cam_from_world, const std::vector<Seen>& seen) const {
    const int columns = DepthGrid::CountAlong(640);
    const int rows = DepthGrid::CountAlong(480);
    std::vector<uint16_t> samples(static_cast<size_t>(columns * rows));
    for (int column = 0; column < columns; ++column) {
      const double slope =
          (DepthGrid::RawPixel(column, 0).x() - sensor_.camera.cx) / sensor_.camera.fx;
      const auto depth = static_cast<uint16_t>(1e3 * WallDepth(cam_from_world, slope));
      for (int row = 0; row < rows; ++row) {
        samples[static_cast<size_t>(row * columns + column)] = depth;
      }
    }
    for (const Seen& object : seen) {
      const Eigen::Matrix2d inverse = object.ellipse.shape.inverse();
      const Eigen::AlignedBox2d box = object.ellipse.Bounds();
      const double half = object.ellipsoid.half_axes.mean();
      for (int row = std::max(0, static_cast<int>(box.min().y()) / 8);
           row <= std::min(rows - 1, static_cast<int>(box.max().y()) / 8); ++row) {
        for (int column = std::max(0, static_cast<int>(box.min().x()) / 8);
             column <= std::min(columns - 1, static_cast<int>(box.max().x()) / 8); ++column) {
          const Eigen::Vector2d offset = DepthGrid::RawPixel(column, row) - object.ellipse.center;
          const double share = offset.dot(inverse * offset);
          if (share < 1.0) {
            samples[static_cast<size_t>(row * columns + column)] =
                static_cast<uint16_t>(1e3 * (object.depth - half * std::sqrt(1.0 - share)));
          }
        }
      }
    }
    return {columns, std::move(samples)};
  }

  void AddPoints(double time, const Rigid3& cam_from_world, const std::vector<Seen>& seen,
                 std::mt19937_64& random, FrameFeatures& features) const {
    constexpr double kLength = 5.0 * kRooms;
    const double camera = AlongOf(cam_from_world);
    const auto before = [](const Point& point, double limit) { return point.along < limit; };
    const auto add = [&](double from, double to) {
      auto point = std::lower_bound(points_.begin(), points_.end(), from, before);
      for (; point != points_.end() && point->along < to; ++point) {
        AddPoint(*point, time, cam_from_world, seen, random, features);
      }
    };
    add(camera - kReach, camera + kReach);
    if (camera < kReach) {
      add(kLength + camera - kReach, kLength);
    } else if (camera > kLength - kReach) {
      add(0.0, camera + kReach - kLength);
    }
  }

  void AddPoint(const Point& point, double time, const Rigid3& cam_from_world,
                const std::vector<Seen>& seen, std::mt19937_64& random,
                FrameFeatures& features) const {
    std::normal_distribution<double> noise(0.0, 0.4);
    Eigen::Vector3d position;
    if (point.object == SIZE_MAX) {
      position = OnRing(point.along, point.height, kWall);
    } else {
      const auto on = std::ranges::find(seen, point.object, &Seen::object);
      if (on == seen.end()) {
        return;
      }
      position = FrontPoint(on->ellipsoid, point.on_object.x(), point.on_object.y());
    }
    const Eigen::Vector3d in_cam = cam_from_world * position;
    const Eigen::Vector2d pixel = sensor_.camera.Project(in_cam);
    if (in_cam.z() < 0.1 || !sensor_.bounds.Contains(pixel)) {
      return;
    }
    for (const Seen& object : seen) {
      const Eigen::Vector2d offset = pixel - object.ellipse.center;
      if (object.object != point.object && in_cam.z() > object.depth &&
          offset.dot(object.ellipse.shape.inverse() * offset) < 1.0) {
        return;  // hidden
      }
    }
    const int level = sensor_.levels.PredictLevel(in_cam.norm(), point.max_distance);
    const double scale = static_cast<double>(sensor_.levels.scale[static_cast<size_t>(level)]);
    Descriptor descriptor = LookOf(point, LightAt(time));
    descriptor[random() % 4] ^= uint64_t{1} << (random() % 64);
    const Eigen::Vector2d error(scale * noise(random), scale * noise(random));
    AddKeypoint(pixel + error, in_cam.z() * (1.0 + 2e-3 * noise(random)), level, point.angle,
                descriptor, features);
  }

  // A point on the side of an object that faces the middle of the ring.
  static Eigen::Vector3d FrontPoint(const Ellipsoid& object, double u, double v) {
    const Eigen::Vector3d& center = object.world_from_object.translation;
    const Eigen::Vector3d inwards = -Eigen::Vector3d(center.x(), 0.0, center.z()).normalized();
    const Eigen::Vector3d side(inwards.z(), 0.0, -inwards.x());
    const Eigen::Vector3d outwards =
        (u * side + v * Eigen::Vector3d::UnitY() + inwards).normalized();
    const Eigen::Vector3d in_object = object.world_from_object.rotation.conjugate() * outwards;
    return object.world_from_object * object.half_axes.cwiseProduct(in_object).eval();
  }

  void AddDetections(const Rigid3& cam_from_world, const std::vector<Seen>& seen,
                     std::mt19937_64& random, Frame& frame) const {
    for (const Seen& object : seen) {
      const size_t label = objects_[object.object].label;
      const bool is_found = random() % 5 != 0;
      const bool is_mistaken = random() % 8 == 0;
      const bool is_doubled = random() % 10 == 0;
      if (is_found) {
        AddDetection(object.ellipsoid, is_mistaken ? label + 1 : label, cam_from_world, frame);
      }
      if (is_found && is_doubled) {
        AddDetection(object.ellipsoid, label + 2, cam_from_world, frame);
      }
    }
    std::uniform_real_distribution<double> offset(-0.8, 0.8);
    const Eigen::Vector3d nowhere =
        Inverse(cam_from_world) * Eigen::Vector3d(offset(random), offset(random), 2.0);
    AddDetection({{Eigen::Quaterniond::Identity(), nowhere}, Eigen::Vector3d::Constant(0.1)},
                 random(), cam_from_world, frame);
  }

  // Nothing if the object is not wholly in the image.
  void AddDetection(const Ellipsoid& object, size_t label, const Rigid3& cam_from_world,
                    Frame& frame) const {
    const auto ellipse = ProjectEllipsoid(sensor_.camera.Matrix(), cam_from_world, object);
    if (!ellipse || !sensor_.bounds.Contains(ellipse->Bounds().min()) ||
        !sensor_.bounds.Contains(ellipse->Bounds().max())) {
      return;
    }
    Detection& detection = frame.detections.emplace_back();
    detection.label = LabelOf(label);
    MadeCorridor::Outline(*ellipse, detection);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 100; ++i) {
      points.push_back(cam_from_world * FrontPoint(object, i % 10 / 4.5 - 1.0, i / 10 / 4.5 - 1.0));
    }
    detection.points = points;
    MadeCorridor::AddKeypointsIn(*ellipse, object, cam_from_world, frame.features, detection);
  }

  const Sensor& sensor_;
  const Vocabulary* const vocabulary_;
  const uint64_t seed_;  // of the rooms
  const size_t lights_;
  const double seconds_;
  const double day_;           // s, of daylight and lamplight together
  const double move_every_;    // s; after four of these times each movable object is elsewhere
  std::vector<Point> points_;  // by their place along the wall
  std::vector<Object> objects_;
};

}  // namespace hullslam
