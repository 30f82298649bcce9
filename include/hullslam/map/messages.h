// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/sim3.h"
#include "hullslam/map/keyframe.h"
#include "hullslam/map/map_events.h"
#include "hullslam/map/tracking_failure.h"
#include "hullslam/util/id.h"

namespace hullslam {

// The keyframes and points that a map, or a new island of it, begins with. An RGB-D run begins with
// one keyframe, a monocular run with two or more.
struct InitialMap {
  struct View {
    std::shared_ptr<const Frame> frame;
    Rigid3 cam_from_world;
  };
  // A keypoint that shows a point.
  struct Observation {
    size_t view = 0;  // index into `views`
    uint32_t keypoint = 0;
  };
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, world frame
    std::vector<Observation> observations;               // at least one, each of another view
  };
  std::vector<View> views;    // in order of time
  std::vector<Point> points;  // in the order in which their landmarks get ids
};

// The number of frames since the last message in which a landmark should have been visible, and the
// number in which it was found.
struct Sighting {
  LandmarkId landmark;
  int visible = 0;
  int found = 0;
};

// A request to the mapper to make a tracked frame a keyframe.
struct KeyframeRequest {
  std::shared_ptr<const Frame> frame;
  RelativePose pose;
  std::vector<LandmarkId> landmarks;  // one per keypoint; invalid where it shows no landmark
  std::vector<Sighting> sightings;    // one per landmark
  // Map::revision() of the oldest snapshot whose ids somebody may still ask for: this request, or
  // frames that are remembered. So the mapper forgets older replacements.
  uint32_t oldest_revision = 0;
};

// The result of a loop closure or a global bundle adjustment: new poses of keyframes. Everything
// that depends on these poses moves with them. The result was computed from a snapshot of the map,
// and the map may have changed since then. map/correction.h applies it.
struct MapCorrection {
  // A keyframe's pose in the snapshot and its new pose.
  struct Pose {
    KeyframeId keyframe;
    Rigid3 snapshot_cam_from_world;
    // Maps the corrected world to the camera frame, which keeps the snapshot's unit of length.
    // So its scale is a length in the snapshot over the same length in the corrected map.
    Sim3 corrected_cam_from_world;
  };
  struct Position {
    LandmarkId landmark;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // in the corrected world
  };
  struct LandmarkMerge {
    LandmarkId duplicate;
    LandmarkId kept;
  };
  struct ObjectMerge {
    ObjectId duplicate;
    ObjectId kept;
  };
  // Two keyframes that see the same place although tracking did not lead from one to the other.
  struct LoopEdge {
    KeyframeId a;
    KeyframeId b;
  };

  // Map::correction_count() of the snapshot. A correction is refused if the map was corrected after
  // the snapshot, because the map then no longer has the world frame of the snapshot.
  uint32_t snapshot_corrections = 0;
  std::vector<Pose> poses;          // by increasing keyframe id, each keyframe once
  std::vector<Position> positions;  // only where a global bundle adjustment has moved landmarks
  std::vector<LandmarkMerge> landmarks;
  std::vector<ObjectMerge> objects;
  std::optional<LoopEdge> loop;
};

// The detections of a frame whose masks came after it was tracked, in the image as read (a rolling
// shutter is not corrected). If a keyframe was made of the frame, it gets them; else a keyframe is
// made of it if the map needs it to know an object (mapping/late_detections.h).
struct LateDetections {
  FrameId frame;
  std::vector<Detection> detections;
  size_t keypoints = 0;  // of the frame, to which the detections refer
  // The keypoints on things of the dynamic classes, by increasing index.
  std::vector<uint32_t> dynamic_keypoints = {};
  // The keyframe that can be made of the frame; absent if it was not tracked in a growing map.
  std::optional<KeyframeRequest> request = std::nullopt;
};

// A user's change of an object, which is skipped if the object was removed meanwhile.
struct ObjectEdit {
  ObjectId object;
  std::optional<std::string> name = std::nullopt;  // ObjectLandmark::IsName
  std::optional<bool> is_locked = std::nullopt;
  std::optional<double> known_size = std::nullopt;  // ObjectLandmark::IsSize, or 0 for none
  bool is_deleted = false;
};

// The messages that the mapper receives.
using MapMessage =
    std::variant<InitialMap, KeyframeRequest, MapCorrection, LateDetections, ObjectEdit>;

enum class TrackingState { kNotInitialized, kTracked, kLost };

// For messages and files: "initialising", "tracked" or "lost".
constexpr std::string_view ToString(TrackingState state) {
  switch (state) {
    case TrackingState::kTracked:
      return "tracked";
    case TrackingState::kLost:
      return "lost";
    default:
      return "initialising";
  }
}

// How the odometry went on from the frame before.
enum class OdometryStep {
  kBegun,      // the frame is the first one with a pose
  kMeasured,   // by the motion between two tracked frames
  kPrior,      // by MotionPrior, because the motion was not measured
  kPredicted,  // with the velocity of the frames before, over lost frames
  kStopped,    // not at all: the velocity is not known (any more)
};

// For messages and files: "begun", "measured" and so on.
constexpr std::string_view ToString(OdometryStep step) {
  switch (step) {
    case OdometryStep::kBegun:
      return "begun";
    case OdometryStep::kMeasured:
      return "measured";
    case OdometryStep::kPrior:
      return "prior";
    case OdometryStep::kPredicted:
      return "predicted";
    default:
      return "stopped";
  }
}

// How the motion prior of a frame was used.
enum class PriorUse {
  kNone,     // there is none, or the frame before has no pose that it could begin at
  kFused,    // as the prediction of the pose and as a measurement beside the landmarks
  kDropped,  // not, because the landmarks contradict it
  kAlone,    // the frame shows too few landmarks, so its pose is dead reckoned by the prior alone
};

// For messages and files: "none", "fused" and so on.
constexpr std::string_view ToString(PriorUse use) {
  switch (use) {
    case PriorUse::kFused:
      return "fused";
    case PriorUse::kDropped:
      return "dropped";
    case PriorUse::kAlone:
      return "alone";
    default:
      return "none";
  }
}

// The pose of the camera in a world in which it never jumps, as REP 105 has it. It is the product
// of the motions from each frame to the next, each as it was estimated in the map of its time. So
// loops, joined islands, rescalings and relocalisations do not move it, but it drifts. Lengths are
// in the unit that the map had at the first pose; a new monocular island begins with a new unit.
struct Odometry {
  // The world of the odometry is that of the map at the first pose.
  Rigid3 odom_from_cam;
  OdometryStep step = OdometryStep::kBegun;
  // Pose of the camera in the map = map_from_odom * odom_from_cam, at tracked frames. At lost
  // frames it is that of the last tracked frame.
  Rigid3 map_from_odom;
  // The last frame at which map_from_odom may have jumped: the map was corrected since the frame
  // before (Map::correction_count), or the step was not measured, as after a relocalisation.
  // Otherwise map_from_odom only follows the local adjustments of the map, a little per keyframe.
  FrameId corrected_at;
  // The mean velocity since the frame before, in the axes of the camera: of its centre (in units of
  // length per second), and rad/s. 0 if the odometry has begun or stopped.
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
};

// One line of the trajectory.
struct TrackedFrame {
  FrameId frame;
  double timestamp = 0.0;  // seconds
  TrackingState state = TrackingState::kNotInitialized;
  // The pose relative to a keyframe, which follows that keyframe when the map is corrected. Absent
  // if the frame is not tracked, or if it belongs to the initial map: then it is a keyframe.
  std::optional<RelativePose> from_keyframe;
  // The pose when the frame was tracked. Later corrections of the map do not change it;
  // System::trajectory() has the corrected poses.
  Rigid3 cam_from_world;
  int inliers = 0;  // landmarks found
  // Without depth: whether the frame would be lost without the landmarks that only two keyframes
  // observe. Such landmarks agree with their two keyframes even if these are wrong, so the pose,
  // and the scale from here on, may be wrong too.
  bool is_unsure = false;
  // The covariance of the small motion d that leads from the pose to the true one: cam_from_world
  // is to become Retract(cam_from_world, d). So d = (rotation in rad, translation) has the axes of
  // the camera. The drift of the map since its first keyframe is part of it (docs/library.md).
  // Absent if the frame is not tracked, or if it belongs to the initial map.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance = std::nullopt;
  // How well the frame determines its pose among the landmarks, 0 to 1: the least probability that
  // the pose places a point in a corner of the image, at the median depth of the landmarks, at most
  // 1 px from its true pixel.
  double quality = 0.0;
  std::optional<Odometry> odometry = std::nullopt;  // absent before the first pose
  // With kAlone the state is kTracked, but no landmark was found.
  PriorUse prior = PriorUse::kNone;

  // The pose of the camera in the world, when the frame was tracked.
  Rigid3 world_from_cam() const { return Inverse(cam_from_world); }
};

// The result of tracking for one frame, for viewers and callbacks.
struct FrameReport {
  TrackedFrame tracked;
  std::shared_ptr<const Frame> frame;
  std::vector<LandmarkId> landmarks;  // one per keypoint; invalid where it shows no landmark
  std::vector<ObjectId> objects;      // one per detection; invalid where it shows no mapped object
  uint32_t map_revision = 0;          // Map::revision() of the snapshot that the ids are of
  // The reason why a monocular camera has no map yet; absent once there is a map.
  std::optional<InitialisationFailure> failure = std::nullopt;
  // The reason why the frame is lost; absent unless its state is kLost.
  std::optional<TrackingFailure> loss = std::nullopt;

  // What has happened to the camera and the map since the frame before. In the pipelines with
  // threads, the map may have changed since it tracked this frame.
  std::vector<MapEvent> events = {};

  // The name of `failure` or `loss`, for messages; absent if there is neither.
  std::optional<std::string_view> Reason() const {
    return failure ? std::optional(ToString(*failure))
           : loss  ? std::optional(ToString(*loss))
                   : std::nullopt;
  }
};

}  // namespace hullslam
