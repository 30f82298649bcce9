// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <list>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/util/cancellation.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The parts of a tracked frame that are kept to compute its pose again later: at most 400 keypoints
// that showed a landmark, and the detections that showed a mapped object, without what the
// residuals of the pose do not need, such as their contours. They take about 7 kB, and 1 kB for
// each detection. While it is kept, the map must remember what has replaced its landmarks and
// objects (Tracker::KeepIdsSince).
struct RememberedFrame {
  struct Point {
    Eigen::Vector2f undistorted;  // px, of the keypoint
    float depth = 0.0f;           // as in FrameFeatures
    LandmarkId landmark;
  };
  Frame MakeFrame() const;  // with the keypoints, depths and detections that are kept

  FrameId id;
  std::vector<Point> points;
  std::vector<uint8_t> levels;  // of the pyramid, one per point
  std::vector<Detection> detections;
  std::vector<ObjectId> objects;  // one per detection
  uint32_t map_revision = 0;      // as in FrameReport
};

// If too many landmarks were found, evenly chosen ones are kept.
RememberedFrame Remember(const FrameReport& report, const PinholeCamera& camera,
                         const ObjectOptions& options);

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
                 const std::list<RememberedFrame>& remembered, std::span<TrackedFrame> frames,
                 const Cancellation* cancellation = nullptr,
                 const ProgressCallback& on_progress = {});

// The most frames that a run remembers, about 55 MB: as much as a walk of 10 000 frames takes for
// its map. They are the last 2.8 minutes of a camera with 30 Hz. By then the camera has left the
// place, or has adjusted it with hundreds of later keyframes. Loops that are closed later still
// move the frame, with its reference.
inline constexpr size_t kMostRemembered = 5000;

// Gives the oldest frames their last poses (RefinePoses) and forgets them, until `most` are left.
// So however long a run is, its remembered frames take bounded memory.
void RefineOldest(const Map& map, const TrackingContext& context, size_t most,
                  std::list<RememberedFrame>& remembered, std::span<TrackedFrame> frames);

}  // namespace hullslam
