// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// What is remembered of a tracked frame, to compute its pose again at the end of the run: the
// keypoints that showed a landmark, at most 400 of them, and the detections that showed a mapped
// object, without their outlines. About 8 kB, and 1 kB for each detection.
struct RememberedFrame {
  Frame frame;                        // of the features only keypoints and right_u
  std::vector<LandmarkId> landmarks;  // one per keypoint
  std::vector<ObjectId> objects;      // one per detection
};

// If more landmarks were found, evenly chosen ones are kept.
RememberedFrame Remember(const FrameReport& report, const ObjectOptions& options);

// Gives tracked frames the poses that the final landmarks and objects explain best (RefinePose).
// The pose of a frame was measured in the map of its time, and it follows one keyframe, its
// reference. But later the map around it changes in other ways than this keyframe: adjustments and
// loops move its landmarks, and a single camera learns the scale of a new place only after it has
// seen it. A frame keeps its pose if fewer than half of the landmarks that were found in it, or
// fewer than tracking.min_inliers, agree with the new one. `frames` are those of the run in order.
void RefinePoses(const Map& map, const TrackingContext& context,
                 std::span<const RememberedFrame> remembered, std::span<TrackedFrame> frames);

}  // namespace hullslam
