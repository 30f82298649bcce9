// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "hullslam/geometry/alignment.h"
#include "hullslam/system/options.h"
#include "support/ring_world.h"
#include "system/compose_trajectory.h"
#include "system/pipeline.h"

namespace hullslam {

// A walk of one and a quarter turns through the ring world. The pipeline uses a focal length that
// is 1 % too long, so it measures every rotation too small. This causes the drift.
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

  // From now on the focal length is right.
  void BeExact() { sensor_ = SharedRing().sensor(); }
  // From now on the camera has no depth, and the focal length is right.
  void BeMonocular() {
    BeExact();
    sensor_.kind = SensorKind::kMonocular;
    options_.sensor = SensorKind::kMonocular;
  }

  // Tracks the frames from `first` to `end` - 1.
  std::vector<TrackedFrame> Track(Pipeline& pipeline, uint32_t first = 0,
                                  uint32_t end = kFrames) const {
    std::vector<TrackedFrame> tracked;
    for (uint32_t i = first; i < end; ++i) {
      const Rigid3 pose = RingWorld::CamFromWorld(static_cast<double>(i) / kFramesPerTurn);
      auto frame = std::make_shared<Frame>(*SharedRing().Observe(FrameId(i), pose).frame);
      if (sensor_.IsMonocular()) {
        std::fill(frame->features.depth.begin(), frame->features.depth.end(), 0.0f);
      }
      tracked.push_back(pipeline.Track(std::move(frame)).tracked);
    }
    return tracked;
  }

  // Tracks frames without keypoints, which are all lost.
  std::vector<TrackedFrame> TrackBlank(Pipeline& pipeline, uint32_t first, uint32_t end) const {
    std::vector<TrackedFrame> tracked;
    for (uint32_t i = first; i < end; ++i) {
      auto blank = std::make_shared<Frame>();
      blank->id = FrameId(i);
      blank->timestamp = i / sensor_.frames_per_second;
      tracked.push_back(pipeline.Track(std::move(blank)).tracked);
      EXPECT_EQ(tracked.back().state, TrackingState::kLost);
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

  // The mean angle, in radians, between the poses of frames of the second turn and those of frames
  // of the first turn that were taken at the same true poses.
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

  // Root mean square distance of the cameras from their true positions after alignment by a
  // similarity, m.
  static double AlignedError(const Trajectory& trajectory) {
    std::vector<Eigen::Vector3d> estimated;
    std::vector<Eigen::Vector3d> truth;
    for (const StampedPose& pose : trajectory) {
      const double turns =
          pose.timestamp * SharedRing().sensor().frames_per_second / kFramesPerTurn;
      estimated.push_back(pose.world_from_cam.translation);
      truth.push_back(Inverse(RingWorld::CamFromWorld(turns)).translation);
    }
    const PointAlignment aligned = AlignPoints(estimated, truth, AlignmentKind::kSim3);
    EXPECT_TRUE(aligned.ok()) << aligned.failure;
    double sum = 0.0;
    for (size_t i = 0; i < truth.size(); ++i) {
      sum += (aligned * estimated[i] - truth[i]).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(truth.size()));
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
