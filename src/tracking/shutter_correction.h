// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "hullslam/features/feature_grid.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "tracking/last_frame.h"
#include "tracking/local_map_tracking.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// A coarse inverse depth image: mean inverse depths (1 over the unit of the map) in cells of 1/16
// of the image's width and 1/12 of its height.
class SeenDepths {
 public:
  // `sensor` must outlive this object. The cells divide the raw image.
  explicit SeenDepths(const Sensor& sensor)
      : sensor_(&sensor), bounds_(sensor.camera.RawBounds()) {}

  // Adds a point at an undistorted pixel. Points that are not in front of the camera are left out.
  void Add(const Eigen::Vector2d& pixel, double depth);
  // The mean of the cell; if it is empty, that of the whole image; 0 if all cells are empty.
  double InverseDepthAt(const Eigen::Vector2d& pixel) const;
  // One inverse depth per keypoint: from its own depth if that is known, else InverseDepthAt().
  std::vector<double> InverseDepths(const FrameFeatures& features) const;

 private:
  static constexpr int kColumns = 16;
  static constexpr int kRows = 12;
  struct Mean {
    double sum = 0.0;
    int count = 0;
  };

  size_t CellOf(const Eigen::Vector2d& undistorted) const;

  const Sensor* sensor_;
  PinholeCamera::Bounds bounds_;
  std::array<Mean, static_cast<size_t>(kColumns* kRows)> cells_{};
  Mean all_;
};

// These functions return the frame as a global shutter would have taken it (WithGlobalShutter), or
// the frame itself if it is of one time (Sensor::HasSeveralTimes) or the velocity of the
// camera is not known. Time stamps may be wrong and images may be missing, so a velocity only
// counts if a camera could move like this (its bounds are in the .cc file). `last` is up to date
// with the map (FollowMap).

// For a frame that is not tracked yet. Assumes that the camera keeps the velocity that corrected
// the last frames, and that the depths are those of the last frame at the same pixels.
std::shared_ptr<const Frame> PredictGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last);

// For a tracked frame. The velocity is that of the motion since the last frame, and the depths are
// those of the landmarks that were found. `frame` is the frame as read, not the predicted one.
std::shared_ptr<const Frame> MeasureGlobalShutter(std::shared_ptr<const Frame> frame,
                                                  const Map& map, const Sensor& sensor,
                                                  const LastFrame& last,
                                                  const PoseEstimate& estimate);

// Whether a correction is kept, after which so many measurements agree with the pose. A correction
// by a wrong velocity contradicts the map, so that fewer measurements agree than before.
bool IsCorrectionKept(int agreeing, int before);

// A tracked frame after the correction of its shutter.
struct CorrectedFrame {
  std::shared_ptr<const Frame> frame;
  std::optional<TimedVelocity> velocity;  // for LastFrame::velocity
};

// Corrects a tracked frame by MeasureGlobalShutter, and optimises its pose again. `tracked` is the
// frame for which `tracking` was found: the one as read or the predicted one. The corrected frame
// and its velocity are only kept if its pose keeps at least tracking.min_inliers and, unless the
// map is still a single frame as it was read, as many inliers as without the correction
// (IsCorrectionKept); landmarks are searched in the corrected frame if those found before do not
// suit it. Otherwise the frame stays as it was tracked. It does not go back from the predicted
// frame to the one as read, because a keyframe that is not corrected contradicts its neighbours.
CorrectedFrame CorrectShutter(const std::shared_ptr<const Frame>& as_read,
                              const std::shared_ptr<const Frame>& tracked, const Map& map,
                              const TrackingContext& context, const LastFrame& last,
                              LocalTracking& tracking);

// For the two or more views of an initial map. The velocity of a view is that of the motion from
// the view before it to the view after it. If one of the velocities is not known, no view is
// corrected, because corrected views and others do not fit together. Returns whether the views are
// corrected.
bool CorrectFrames(const Sensor& sensor, InitialMap& map);

}  // namespace hullslam
