// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "support/synthetic_world.h"
#include "support/unknown_points.h"
#include "system/compose_trajectory.h"
#include "system/pipeline.h"

// Parts that the tests of the pipelines have in common.
namespace hullslam {

// A made-up world with noise like that of real features.
inline SyntheticWorld NoisyWorld(uint64_t seed = 1) {
  return SyntheticWorld(
      {.points = 500, .pixel_noise = 0.2, .depth_share = 0.8, .flipped_bits = 8, .seed = seed});
}

// The path's frame; every fifth has new close points, so that it should become a keyframe.
inline std::shared_ptr<const Frame> PathFrame(const SyntheticWorld& world, uint32_t index) {
  auto frame = std::make_shared<Frame>(*world.Observe(index).frame);
  if (index % 5 == 4) {
    AddUnknownPoints(world.sensor(), 80, 0, *frame);
  }
  return frame;
}

// Tracks the path's frames from `first` to `end` - 1.
inline std::vector<TrackedFrame> TrackPath(Pipeline& pipeline, const SyntheticWorld& world,
                                           uint32_t first, uint32_t end) {
  std::vector<TrackedFrame> tracked;
  for (uint32_t i = first; i < end; ++i) {
    tracked.push_back(pipeline.Track(PathFrame(world, i)).tracked);
  }
  return tracked;
}

// Root mean square distance in metres between the trajectory's camera centres and the path. The
// world is the camera of frame 0 in both, so nothing is aligned.
inline double PathError(const Trajectory& trajectory, const Sensor& sensor) {
  double sum = 0.0;
  for (const StampedPose& pose : trajectory) {
    const double index = pose.timestamp * sensor.frames_per_second;
    const Rigid3 world_from_cam = Inverse(SyntheticWorld::CamFromWorld(index));
    sum += (pose.world_from_cam.translation - world_from_cam.translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(trajectory.size()));
}

// Two frames that can be tracked but make mapping fail: the second has close points at a level
// whose scale is not a number, and fusion searches these points in the first.
struct FailingMapping {
  static constexpr int kBrokenLevel = 7;

  FailingMapping() {
    const SyntheticWorld world({.points = 300});
    sensor.frames_per_second = 1.0;  // so slow that the next frame may be a keyframe
    sensor.levels.scale[kBrokenLevel] = std::numeric_limits<float>::quiet_NaN();
    first = WithoutUpperLevels(*world.Observe(0).frame);
    auto with_more = WithoutUpperLevels(*world.Observe(1).frame);
    AddUnknownPoints(sensor, 80, kBrokenLevel, *with_more);
    second = with_more;
  }

  Sensor sensor = SyntheticSensor();
  std::shared_ptr<const Frame> first;
  std::shared_ptr<const Frame> second;

 private:
  static std::shared_ptr<Frame> WithoutUpperLevels(const Frame& frame) {
    auto changed = std::make_shared<Frame>(frame);
    for (Keypoint& keypoint : changed->features.keypoints) {
      keypoint.level = std::min(keypoint.level, 4);
    }
    return changed;
  }
};

}  // namespace hullslam
