// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>

#include "live/live_inbox.h"
#include "live/live_messages.h"
#include "support/synthetic_world.h"

namespace hullslam {

// A frame of the path of a SyntheticWorld as the run hands it over, with a grey image of stripes.
// Every second of its keypoints is matched.
inline LiveFrame MadeLiveFrame(const SyntheticWorld& world, uint32_t index,
                               std::shared_ptr<const Map> map) {
  LiveFrame frame;
  frame.report.frame = world.Observe(index).frame;
  frame.report.tracked.frame = frame.report.frame->id;
  frame.report.tracked.timestamp = frame.report.frame->timestamp;
  frame.report.tracked.state = TrackingState::kTracked;
  frame.report.tracked.cam_from_world = SyntheticWorld::CamFromWorld(index);
  frame.report.tracked.inliers = 123;
  frame.report.landmarks.resize(frame.report.frame->features.size());
  for (size_t i = 0; i < frame.report.landmarks.size(); i += 2) {
    frame.report.landmarks[i] = LandmarkId(0);
  }
  frame.map = std::move(map);
  const PinholeCamera& camera = world.sensor().camera;
  frame.grey = cv::Mat(camera.height, camera.width, CV_8UC1);
  for (int y = 0; y < frame.grey.rows; ++y) {
    frame.grey.row(y).setTo(static_cast<double>(y % 256));
  }
  frame.number = index + 1;
  return frame;
}

inline LiveRun MadeLiveRun(const SyntheticWorld& world) {
  LiveRun run;
  run.title = "made <run>";
  run.program = "rgbd_tum";
  run.sensor = world.sensor();
  run.frame_count = 200;
  return run;
}

}  // namespace hullslam
