// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "optim/joint_pose_optimization.h"
#include "tracking/pose_estimate.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The estimate with the pose that its landmarks and the objects explain best (OptimizeJointPose).
// Landmarks that do not agree with this pose are left out of it.
PoseEstimate RefinePose(const Frame& frame, const Map& map, const TrackingContext& context,
                        std::span<const PoseObject> objects, PoseEstimate estimate);

}  // namespace hullslam
