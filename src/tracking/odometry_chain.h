// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "hullslam/map/messages.h"
#include "tracking/last_frame.h"

namespace hullslam {

// Composes the odometry of a run (Odometry).
class OdometryChain {
 public:
  // The odometry of the next frame; absent before the first tracked one. last.motion is the motion
  // to it if it was measured, `prior` that of the frame, and `corrections` Map::correction_count()
  // of the map that it was tracked in.
  std::optional<Odometry> Add(const TrackedFrame& tracked, const LastFrame& last,
                              const std::optional<MotionPrior>& prior, uint32_t corrections);

 private:
  std::optional<Odometry> odometry_;  // of the last frame
  double timestamp_ = 0.0;            // s, of the last frame
  uint32_t corrections_ = 0;
  // The last measured motion, in the unit of the odometry, and the time until which it predicts.
  CameraMotion motion_;
  double end_of_prediction_ = 0.0;  // s
};

}  // namespace hullslam
