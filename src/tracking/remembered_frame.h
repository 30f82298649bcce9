// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/util/cancellation.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The parts of a tracked frame that are kept to compute its pose again at the end of the run: at
// most 400 keypoints that showed a landmark, and the detections that showed a mapped object,
// without their contours. They take about 8 kB, and 1 kB for each detection.
struct RememberedFrame {
  Frame frame;                        // its features have only keypoints and right_u
  std::vector<LandmarkId> landmarks;  // one per keypoint
  std::vector<ObjectId> objects;      // one per detection
};

// If too many landmarks were found, evenly chosen ones are kept.
RememberedFrame Remember(const FrameReport& report, const ObjectOptions& options);

// Gives tracked frames the poses that the final landmarks and objects explain best (RefinePose).
// The pose of a frame was measured in the map at that time and follows one keyframe, its reference.
// Later the map around the frame changes differently from this keyframe: adjustments and loops move
// its landmarks, and a monocular camera knows the scale of a new place only some time after it has
// entered it. A frame that became a keyframe and was culled begins with the pose of the keyframe,
// and its pose is relative to it afterwards. A frame keeps its pose if fewer than half of the
// landmarks that were found in it, or fewer than tracking.min_inliers, agree with the new pose.
// `frames` are those of the run in order. `on_progress` is called after each frame. Once
// `cancellation` (may be null) is requested, the other frames keep their poses.
void RefinePoses(const Map& map, const TrackingContext& context,
                 std::span<const RememberedFrame> remembered, std::span<TrackedFrame> frames,
                 const Cancellation* cancellation = nullptr,
                 const ProgressCallback& on_progress = {});

}  // namespace hullslam
