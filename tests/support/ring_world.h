// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "map_files/train_vocabulary.h"
#include "support/synthetic_world.h"
#include "support/unknown_points.h"
#include "util/task_runner.h"

namespace hullslam {

// Points all around the camera: six synthetic worlds in a ring. The camera moves on a circle and
// looks outward. After one turn it sees the points of the beginning again, and it sees none of them
// in between. Frames have words of a vocabulary that was trained on this world.
class RingWorld {
 public:
  static constexpr uint32_t kSectors = 6;
  static constexpr double kRadius = 0.8;  // m, of the circle

  // Each sector has `points` points of the options.
  explicit RingWorld(const SyntheticWorldOptions& options = {.points = 300, .pixel_noise = 0.2}) {
    for (uint32_t i = 0; i < kSectors; ++i) {
      SyntheticWorldOptions of_sector = options;
      of_sector.seed = kSectors * options.seed + i;
      sectors_.emplace_back(of_sector);
    }
    vocabulary_ = Train();
  }

  const Sensor& sensor() const { return sectors_.front().sensor(); }
  const std::shared_ptr<const Vocabulary>& vocabulary() const { return vocabulary_; }

  size_t point_count() const { return kSectors * sectors_.front().points().size(); }
  // m, world frame
  Eigen::Vector3d point(uint32_t i) const {
    const auto count = static_cast<uint32_t>(sectors_.front().points().size());
    return WorldFromSector(i / count) * sectors_[i / count].points()[i % count];
  }

  // The pose after `turns` turns. At 0 turns the camera frame is the world frame.
  static Rigid3 CamFromWorld(double turns) {
    const Eigen::Quaterniond rotation = ExpSo3({0.0, -2.0 * std::numbers::pi * turns, 0.0});
    // The centre of the circle is behind the camera.
    const Eigen::Vector3d behind(0.0, 0.0, -kRadius);
    return {rotation, rotation * -behind + behind};
  }

  SyntheticView Observe(FrameId id, const Rigid3& cam_from_world) const {
    auto frame = std::make_shared<Frame>();
    std::vector<uint32_t> points;
    for (uint32_t i = 0; i < kSectors; ++i) {
      const SyntheticView view = sectors_[i].Observe(id, cam_from_world * WorldFromSector(i));
      Append(view.frame->features, frame->features);
      frame->id = id;
      frame->timestamp = view.frame->timestamp;
      for (const uint32_t point : view.points) {
        points.push_back(i * static_cast<uint32_t>(sectors_[i].points().size()) + point);
      }
    }
    RebuildGrid(sensor(), *frame);
    if (vocabulary_ != nullptr) {
      frame->words = vocabulary_->WordsOf(frame->features.descriptors);
    }
    return {std::move(frame), std::move(points)};
  }

 private:
  // The pose of a sector in the world. Each sector is in front of the camera during one sixth of
  // the turn.
  static Rigid3 WorldFromSector(uint32_t sector) {
    return Inverse(CamFromWorld(static_cast<double>(sector) / kSectors));
  }

  static void Append(const FrameFeatures& from, FrameFeatures& to) {
    to.keypoints.insert(to.keypoints.end(), from.keypoints.begin(), from.keypoints.end());
    to.descriptors.insert(to.descriptors.end(), from.descriptors.begin(), from.descriptors.end());
    to.depth.insert(to.depth.end(), from.depth.begin(), from.depth.end());
  }

  std::shared_ptr<const Vocabulary> Train() const {
    constexpr uint32_t kImages = 24;
    std::vector<std::vector<Descriptor>> images;
    for (uint32_t i = 0; i < kImages; ++i) {
      const double turns = static_cast<double>(i) / kImages;
      images.push_back(
          Observe(FrameId(10'000 + i), CamFromWorld(turns)).frame->features.descriptors);
    }
    SerialRunner runner;
    return std::make_shared<const Vocabulary>(
        *TrainVocabulary(images, {.branching = 10, .levels = 3, .seed = 1}, runner));
  }

  std::vector<SyntheticWorld> sectors_;
  std::shared_ptr<const Vocabulary> vocabulary_;  // null while it is trained
};

// The world that most tests share; it is made only once.
inline const RingWorld& SharedRing() {
  static const RingWorld world;
  return world;
}

// Options for a map of somewhat more than one turn in the ring world. The second half of the map
// has drifted.
struct RingMapOptions {
  uint32_t keyframes = 30;
  uint32_t keyframes_per_turn = 24;
  // The drift at the end, drifted_world_from_world. It is zero up to a third of a turn, grows
  // evenly up to two thirds of a turn, and then stays.
  Rigid3 drift = Rigid3(ExpSo3({0.01, 0.04, -0.02}), {0.2, -0.1, 0.25});
  bool has_vocabulary = true;
  // If not 0, keyframes from this one on share no landmark with earlier ones, and the pose alone
  // ties it to the keyframe before it.
  uint32_t tied = 0;
};

// Landmarks are points that at least two keyframes of the same turn see. Those of the last turn are
// not joined with those of the first, as if no loop had been closed.
struct RingMap {
  Map map;
  std::vector<SyntheticView> views;         // one per keyframe
  std::vector<Rigid3> true_cam_from_world;  // one per keyframe
  std::vector<Rigid3> drifted_from_world;   // one per keyframe
  KeyframeId first() const { return KeyframeId(0); }
  KeyframeId last() const { return KeyframeId(static_cast<uint32_t>(views.size()) - 1); }
};

inline RingMap MakeRingMap(const RingWorld& world, const RingMapOptions& options = {},
                           const FrameDecoration& decorate = {}) {
  RingMap made;
  if (options.has_vocabulary) {
    made.map = Map(world.vocabulary());
  }
  using Sightings = std::vector<std::pair<uint32_t, uint32_t>>;  // keyframe and keypoint
  std::vector<Sightings> seen(world.point_count());
  for (uint32_t i = 0; i < options.keyframes; ++i) {
    const double turns = static_cast<double>(i) / options.keyframes_per_turn;
    const Rigid3 pose = RingWorld::CamFromWorld(turns);
    SyntheticView& view = made.views.emplace_back(world.Observe(FrameId(3 * i), pose));
    if (decorate || options.tied > 0) {
      auto frame = std::make_shared<Frame>(*view.frame);
      frame->motion = MotionPrior();
      if (decorate) {
        decorate(*frame, pose);
      }
      view.frame = std::move(frame);
    }
    const double share = std::clamp(3.0 * turns - 1.0, 0.0, 1.0);
    made.true_cam_from_world.push_back(pose);
    made.drifted_from_world.push_back(PartOfMotion(options.drift, share));
    made.map.AddKeyframe(view.frame, pose * Inverse(made.drifted_from_world.back()));
    for (uint32_t keypoint = 0; keypoint < view.points.size(); ++keypoint) {
      seen[view.points[keypoint]].emplace_back(i, keypoint);
    }
  }
  const auto add_landmark = [&](uint32_t point, const Sightings& sightings) {
    const uint32_t middle = sightings[sightings.size() / 2].first;
    const LandmarkId landmark = made.map.AddLandmark(
        made.drifted_from_world[middle] * world.point(point), KeyframeId(sightings.front().first));
    for (const auto& [keyframe, keypoint] : sightings) {
      made.map.AddObservation(landmark, KeyframeId(keyframe), keypoint);
    }
    UpdateDescriptor(made.map, landmark);
    UpdateViewingGeometry(made.map, landmark, world.sensor().levels);
  };
  for (uint32_t point = 0; point < seen.size(); ++point) {
    Sightings run;
    for (const auto& sighting : seen[point]) {
      const bool is_new_turn =
          !run.empty() && (sighting.first - run.back().first > options.keyframes_per_turn / 2 ||
                           (run.back().first < options.tied && sighting.first >= options.tied));
      if (is_new_turn && run.size() >= 2) {
        add_landmark(point, run);
      }
      if (is_new_turn) {
        run.clear();
      }
      run.push_back(sighting);
    }
    if (run.size() >= 2) {
      add_landmark(point, run);
    }
  }
  for (uint32_t i = 0; i < options.keyframes; ++i) {
    UpdateCovisibility(made.map, KeyframeId(i));
  }
  if (options.tied > 0) {
    SetParent(made.map, KeyframeId(options.tied), KeyframeId(options.tied - 1));
  }
  return made;
}

// The error of the pose of a keyframe: the sum of metres and radians.
inline double PoseError(const RingMap& made, const Map& map, KeyframeId id) {
  const Rigid3 difference = map.CamFromWorld(id) * Inverse(made.true_cam_from_world[id.value]);
  return difference.translation.norm() +
         AngularDistance(difference.rotation, Eigen::Quaterniond::Identity());
}

}  // namespace hullslam
