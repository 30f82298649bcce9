// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "hullslam/system/compose_trajectory.h"
#include "hullslam/system/options.h"
#include "support/ring_world.h"
#include "system/pipeline.h"
#include "system/sequential_pipeline.h"

namespace hullslam {

// A walk of one and a quarter turns through the ring world. The focal length that the pipeline
// believes in is 1 % too long, so that it measures every turn too short: this is the drift.
class RingPath {
 public:
  static constexpr uint32_t kFramesPerTurn = 144;
  static constexpr uint32_t kFrames = 180;

  RingPath() {
    sensor_ = SharedRing().sensor();
    sensor_.camera.fx *= 1.01;
    sensor_.camera.fy *= 1.01;
    options_.vocabulary = SharedRing().vocabulary();
  }

  const Sensor& sensor() const { return sensor_; }
  SystemOptions& options() { return options_; }

  // Tracks the frames from `first` to `end` - 1.
  std::vector<TrackedFrame> Track(Pipeline& pipeline, uint32_t first = 0,
                                  uint32_t end = kFrames) const {
    std::vector<TrackedFrame> tracked;
    for (uint32_t i = first; i < end; ++i) {
      const Rigid3 pose = RingWorld::CamFromWorld(static_cast<double>(i) / kFramesPerTurn);
      tracked.push_back(pipeline.Track(SharedRing().Observe(FrameId(i), pose).frame).tracked);
    }
    return tracked;
  }

  // Tracks frames until a loop is in the map, or to the end of the path. Returns their number.
  uint32_t TrackToLoop(Pipeline& pipeline) const {
    uint32_t end = 0;
    while (end < kFrames && (end == 0 || CountLoopEnds(*pipeline.map()) == 0)) {
      Track(pipeline, end, end + 1);
      ++end;
    }
    return end;
  }
  // The number of frames after which a pipeline without threads has closed the loop.
  uint32_t FirstLoop() const { return TrackToLoop(*MakeSequentialPipeline(sensor_, options_)); }

  // By which angle, in radians, frames of the second turn differ from those of the first turn that
  // were taken at the same poses: their mean.
  static double ClosureError(const Map& map, const std::vector<TrackedFrame>& frames) {
    const Trajectory trajectory = ComposeTrajectory(map, frames);
    EXPECT_EQ(trajectory.size(), frames.size()) << "all are tracked";
    double sum = 0.0;
    int count = 0;
    for (size_t i = kFramesPerTurn; i < trajectory.size(); ++i) {
      sum += AngularDistance(trajectory[i].world_from_cam.rotation,
                             trajectory[i - kFramesPerTurn].world_from_cam.rotation);
      ++count;
    }
    return sum / count;
  }

  // The number of keyframes that are one end of a loop.
  static int CountLoopEnds(const Map& map) {
    int count = 0;
    for (const auto& [id, keyframe] : map.keyframes()) {
      count += keyframe.loops.empty() ? 0 : 1;
    }
    return count;
  }

 private:
  Sensor sensor_;
  SystemOptions options_;
};

}  // namespace hullslam
