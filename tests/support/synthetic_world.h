// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "frame/keypoint_grid.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "util/hash.h"

namespace hullslam {

// A camera without distortion, with images of 640 x 480 px and a baseline of 0.08 m. Depths up to
// 3.2 m count as close.
inline Sensor SyntheticSensor() {
  Sensor sensor;
  sensor.camera = {.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};
  sensor.bounds = sensor.camera.UndistortedBounds();
  sensor.levels = ScaleLevels::Create(8, 1.2);
  sensor.close_depth = 3.2;
  return sensor;
}

struct SyntheticWorldOptions {
  int points = 600;
  // px, standard deviation of u and v at level 0, in the raw image of a fisheye lens, and of the
  // disparity at every level.
  double pixel_noise = 0.0;
  double depth_share = 1.0;  // share of the points that have a depth in every frame that sees them
  int flipped_bits = 0;      // flipped bits of each descriptor; every frame flips other bits
  // The frames of the path are those of a shutter like this (see Sensor).
  double readout_time = 0.0;  // s
  ReadoutDirection readout_direction = ReadoutDirection::kRows;
  uint64_t seed = 1;
};

// One frame of the synthetic world.
struct SyntheticView {
  std::shared_ptr<const Frame> frame;
  std::vector<uint32_t> points;  // indices into SyntheticWorld::points(), one per keypoint
};

// Random points in a box of 5 x 3.6 x 4 m, 2 to 6 m in front of the origin. Frames of them are made
// without images: keypoints are exact projections (rounded to float) plus noise, descriptors are
// random and far apart, and a keypoint's level follows from its distance. No point hides another.
// The same options give the same bits.
class SyntheticWorld {
 public:
  explicit SyntheticWorld(const SyntheticWorldOptions& options = {},
                          const Sensor& sensor = SyntheticSensor())
      : options_(options), sensor_(sensor) {
    sensor_.readout_time = options.readout_time;
    sensor_.readout_direction = options.readout_direction;
    std::mt19937_64 random(HashSeed(options.seed, 0, "points"));
    const auto number = [&random](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < options.points; ++i) {
      // Drawn in separate statements, because C++ does not specify in which order the arguments of
      // a call are evaluated.
      const double z = number(2.0, 6.0);
      const double y = number(-1.8, 1.8);
      const double x = number(-2.5, 2.5);
      points_.emplace_back(x, y, z);
      Patch& patch = patches_.emplace_back();
      patch.descriptor = {random(), random(), random(), random()};
      patch.angle = static_cast<float>(number(0.0, 2.0 * std::numbers::pi));
      patch.max_distance = number(5.0, 15.0);
      patch.has_depth = number(0.0, 1.0) < options.depth_share;
    }
  }

  const Sensor& sensor() const { return sensor_; }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }  // m, world frame
  const Descriptor& descriptor(uint32_t point) const { return patches_[point].descriptor; }
  bool has_depth(uint32_t point) const { return patches_[point].has_depth; }

  // The pose of frame `index` on a smooth path. Neighbouring frames are about 2 cm apart. The
  // camera looks at the middle of the points. The world frame is the camera frame of index 0. The
  // path is closed after 200 frames.
  static Rigid3 CamFromWorld(double index) {
    const double phase = 2.0 * std::numbers::pi * index / 200.0;
    const Eigen::Vector3d center(0.6 * std::sin(phase), 0.25 * std::sin(2.0 * phase),
                                 0.4 * (1.0 - std::cos(phase)));
    return LookAt(center, {0.0, 0.0, 4.0});
  }

  // Pose of a camera at `center` that looks at `target`, upright (the world's y points down).
  static Rigid3 LookAt(const Eigen::Vector3d& center, const Eigen::Vector3d& target) {
    const Eigen::Vector3d z = (target - center).normalized();
    const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
    Eigen::Matrix3d rotation;
    rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
    return {Eigen::Quaterniond(rotation), -(rotation * center)};
  }

  // The frame seen from a pose. Noise and flipped bits depend only on the seed and the frame's id.
  SyntheticView Observe(FrameId id, const Rigid3& cam_from_world) const {
    return ObserveRows(id, [&](double) { return cam_from_world; });
  }
  // Frame `index` of the path.
  SyntheticView Observe(uint32_t index) const {
    const double frames = sensor_.readout_time * sensor_.frames_per_second;
    return ObserveRows(FrameId(index),
                       [&](double place) { return CamFromWorld(index + frames * place); });
  }

 private:
  // `cam_from_world_at` is the pose at a row or column of the image: -0.5 is the top or left one,
  // 0.5 the bottom or right one.
  template <typename PoseAt>
  SyntheticView ObserveRows(FrameId id, const PoseAt& cam_from_world_at) const {
    std::mt19937_64 random(HashSeed(options_.seed, id.value, "noise"));
    auto frame = std::make_shared<Frame>();
    frame->id = id;
    frame->timestamp = id.value / sensor_.frames_per_second;
    std::vector<uint32_t> points;
    for (uint32_t i = 0; i < points_.size(); ++i) {
      Eigen::Vector3d point_in_cam = cam_from_world_at(0.0) * points_[i];
      for (int k = 0; sensor_.readout_time != 0.0 && k < 10; ++k) {
        const Eigen::Vector2d pixel = sensor_.camera.Distort(sensor_.camera.Project(point_in_cam));
        const double place = sensor_.readout_direction == ReadoutDirection::kRows
                                 ? pixel.y() / sensor_.camera.height
                                 : pixel.x() / sensor_.camera.width;
        point_in_cam = cam_from_world_at(std::clamp(place - 0.5, -0.5, 0.5)) * points_[i];
      }
      if (point_in_cam.z() > 0.1 && sensor_.Sees(sensor_.camera.Project(point_in_cam))) {
        AddKeypoint(patches_[i], point_in_cam, random, frame->features);
        points.push_back(i);
      }
    }
    frame->features.grid = MakeKeypointGrid(frame->features.keypoints, sensor_.camera);
    return {std::move(frame), std::move(points)};
  }

  struct Patch {
    Descriptor descriptor{};
    float angle = 0.0f;
    double max_distance = 0.0;  // m, the largest distance at which it is seen at level 0
    bool has_depth = true;
  };

  void AddKeypoint(const Patch& patch, const Eigen::Vector3d& point_in_cam, std::mt19937_64& random,
                   FrameFeatures& features) const {
    const int level = sensor_.levels.PredictLevel(point_in_cam.norm(), patch.max_distance);
    std::normal_distribution<double> normal;
    const double sigma = options_.pixel_noise *
                         static_cast<double>(sensor_.levels.scale[static_cast<size_t>(level)]);
    Eigen::Vector2d pixel = sensor_.camera.Distort(sensor_.camera.Project(point_in_cam));
    pixel.x() += sigma * normal(random);
    pixel.y() += sigma * normal(random);
    const double disparity =
        sensor_.camera.bf / point_in_cam.z() + options_.pixel_noise * normal(random);
    Keypoint& keypoint = features.keypoints.emplace_back();
    keypoint.undistorted = sensor_.camera.Undistort(pixel).cast<float>();
    keypoint.angle = patch.angle;
    keypoint.level = level;
    Descriptor& descriptor = features.descriptors.emplace_back(patch.descriptor);
    for (int i = 0; i < options_.flipped_bits; ++i) {
      const uint64_t bit = random() % 256;
      descriptor[bit / 64] ^= uint64_t{1} << (bit % 64);
    }
    const bool has_depth = patch.has_depth && disparity > 0.0;
    features.depth.push_back(has_depth ? static_cast<float>(sensor_.camera.bf / disparity) : 0.0f);
  }

  SyntheticWorldOptions options_;
  Sensor sensor_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Patch> patches_;
};

// A map of the synthetic world with every landmark at its true position. The other members tell the
// view of each keyframe and the landmark of each point.
struct SyntheticMap {
  Map map;
  std::vector<SyntheticView> views;   // one per keyframe
  std::vector<LandmarkId> landmarks;  // one per point; invalid if the point is no landmark
};

// Adds things to a frame that the camera sees besides the points, such as objects.
using FrameDecoration = std::function<void(Frame& frame, const Rigid3& cam_from_world)>;

// Makes a map whose keyframes are the frames `indices` of the path, in this order. Its landmarks
// are the points that at least two of them see. Covisibility, spanning tree, and the landmarks'
// descriptors and viewing geometry are up to date.
inline SyntheticMap MakeSyntheticMap(const SyntheticWorld& world,
                                     const std::vector<uint32_t>& indices,
                                     const FrameDecoration& decorate = {}) {
  SyntheticMap made;
  std::vector<std::vector<std::pair<KeyframeId, uint32_t>>> seen(world.points().size());
  for (const uint32_t index : indices) {
    SyntheticView& view = made.views.emplace_back(world.Observe(index));
    if (decorate) {
      auto frame = std::make_shared<Frame>(*view.frame);
      decorate(*frame, SyntheticWorld::CamFromWorld(index));
      view.frame = std::move(frame);
    }
    const KeyframeId id = made.map.AddKeyframe(view.frame, SyntheticWorld::CamFromWorld(index));
    for (uint32_t keypoint = 0; keypoint < view.points.size(); ++keypoint) {
      seen[view.points[keypoint]].emplace_back(id, keypoint);
    }
  }
  made.landmarks.resize(world.points().size());
  for (uint32_t point = 0; point < seen.size(); ++point) {
    if (seen[point].size() < 2) {
      continue;
    }
    const LandmarkId landmark =
        made.map.AddLandmark(world.points()[point], seen[point].front().first);
    for (const auto& [keyframe, keypoint] : seen[point]) {
      made.map.AddObservation(landmark, keyframe, keypoint);
    }
    UpdateDescriptor(made.map, landmark);
    UpdateViewingGeometry(made.map, landmark, world.sensor().levels);
    made.landmarks[point] = landmark;
  }
  for (uint32_t i = 0; i < indices.size(); ++i) {
    UpdateCovisibility(made.map, KeyframeId(i));
  }
  return made;
}

}  // namespace hullslam
