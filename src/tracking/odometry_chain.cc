// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/odometry_chain.h"

#include <utility>

namespace hullslam {

std::optional<Odometry> OdometryChain::Add(const TrackedFrame& tracked, const LastFrame& last,
                                           const std::optional<MotionPrior>& prior,
                                           uint32_t corrections) {
  const bool is_tracked = tracked.state == TrackingState::kTracked;
  const double time_step = tracked.timestamp - std::exchange(timestamp_, tracked.timestamp);
  const bool was_corrected = std::exchange(corrections_, corrections) != corrections;
  if (!odometry_) {
    if (is_tracked) {
      odometry_.emplace();
      odometry_->odom_from_cam = tracked.world_from_cam();
      odometry_->corrected_at = tracked.frame;
    }
    return odometry_;
  }
  Rigid3 cam_from_last;
  if (is_tracked && last.motion) {
    odometry_->step = OdometryStep::kMeasured;
    cam_from_last = last.motion->cam_from_last_cam;
    cam_from_last.translation /= last.map_per_odometry;
    motion_ = {cam_from_last, time_step};
    end_of_prediction_ = tracked.timestamp + kMaxExtrapolation * time_step;
  } else if (prior) {
    odometry_->step = OdometryStep::kPrior;
    cam_from_last = prior->cam_from_last_cam;
  } else if (tracked.timestamp <= end_of_prediction_) {
    odometry_->step = OdometryStep::kPredicted;
    cam_from_last = PartOfMotion(motion_.cam_from_last_cam, time_step / motion_.duration);
  } else {
    odometry_->step = OdometryStep::kStopped;
  }
  odometry_->odom_from_cam = odometry_->odom_from_cam * Inverse(cam_from_last);
  odometry_->linear_velocity = -MeanVelocity(cam_from_last, time_step).linear;
  odometry_->angular_velocity = -MeanVelocity(cam_from_last, time_step).angular;
  if (is_tracked) {
    odometry_->map_from_odom = tracked.world_from_cam() * Inverse(odometry_->odom_from_cam);
    const bool is_continued =
        odometry_->step == OdometryStep::kMeasured || tracked.prior == PriorUse::kAlone;
    if (was_corrected || !is_continued) {
      odometry_->corrected_at = tracked.frame;
    }
  }
  return odometry_;
}

}  // namespace hullslam
