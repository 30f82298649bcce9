// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "frame/rolling_shutter.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/keyframe.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The motion from one tracked frame to the next.
struct CameraMotion {
  Rigid3 cam_from_last_cam;
  double duration = 0.0;  // s; negative between frames that are tracked against the order of time
};

// The velocity of the camera, and when it was measured.
struct TimedVelocity {
  PointVelocity velocity;
  double duration = 0.0;   // s, of the motion from which it follows
  double timestamp = 0.0;  // s, of the end of this motion
};

// The frame that was tracked last, as tracking remembers it.
struct LastFrame {
  std::shared_ptr<const Frame> frame;
  std::vector<LandmarkId> landmarks;  // one per keypoint; invalid where it shows no landmark
  // Absent for a frame of the initial map until FollowMap is given that map.
  std::optional<RelativePose> pose;
  // The keyframe that shares most landmarks with the frame.
  KeyframeId reference;
  Rigid3 cam_from_world;               // in the map that FollowMap was given
  std::optional<CameraMotion> motion;  // to this frame; absent after lost frames
  // The velocity that last corrected a frame of a rolling shutter (CorrectShutter).
  std::optional<TimedVelocity> velocity;
  // A length of 1 in the odometry has this length in the map.
  double map_per_odometry = 1.0;
  double followed_change = 1.0;  // of the unit since `pose` was made, as FollowMap knows it
  // The covariance of the pose by the frame's own measurements if all errors are independent; with
  // those that are shared (P of DriftModel); and all of it. In the axes of the camera. 0 for a
  // frame of the initial map.
  Eigen::Matrix<double, 6, 6> measured_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> shared_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double median_depth = 0.0;  // of the landmarks
  // The motion by priors from this frame to the one that is tracked now (MotionAhead).
  std::optional<MotionPrior> ahead = std::nullopt;
};

// The motion from the last frame to this one, if the priors of all frames since then are known:
// last.ahead is that to the frame before this one, absent if this is the last frame.
std::optional<MotionPrior> MotionAhead(const LastFrame& last, const Frame& frame);

// Brings the last frame up to date with the current map: its pose, the scale of its motion, its
// reference keyframe and its landmarks. If the frame has become a keyframe, it gets the landmarks
// of that keyframe. Throws CheckError if the map knows neither the frame nor its reference.
LastFrame FollowMap(const Map& map, LastFrame last);

// The motion from the last frame to this one. Absent if there is no last frame, or if frames
// between the two were lost: a mean velocity over a long time is not the current one.
std::optional<CameraMotion> MotionSince(const LastFrame& last, const Frame& frame,
                                        const Rigid3& cam_from_world);

// The longest time for which a motion predicts the next one, over its own duration.
inline constexpr double kMaxExtrapolation = 4.0;

// The motion from the last frame to a frame at `timestamp` (s): last.ahead if it is known, else
// that of a camera that keeps its velocity. Null if the velocity is not known, or if it may have
// changed: the time step is much longer than the one over which the velocity was measured.
std::optional<Rigid3> PredictMotion(const LastFrame& last, double timestamp);

// The share of the landmarks that a camera at `cam_from_world` has in its image. Ids that are
// invalid or that the map does not have are left out; 1 if none remains.
double ShareInImage(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                    std::span<const LandmarkId> landmarks);

// The share of the view of the keyframe `reference` that the next image will show at least, if the
// camera moves from this frame, at `cam_from_world`, as far as it moved from the last frame to this
// one, in whatever direction. If this image shows the share r of the reference's landmarks and the
// share s of the last frame's, one such motion loses 1 - s, so r - (1 - s) remains.
double NextOverlap(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                   KeyframeId reference, const LastFrame& last);

}  // namespace hullslam
