// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/tracking/tracking_options.h"
#include "hullslam/util/stage_timer.h"
#include "tracking/keyframe_policy.h"
#include "tracking/pose_objects.h"
#include "tracking/sighting_counter.h"

namespace hullslam {

// Whether the mapper can take a keyframe right now.
struct MapperStatus {
  bool is_idle = true;
  int requests_waiting = 0;
};

// Finds the pose of each frame in a snapshot of the map and decides on keyframes. It writes
// nothing: what it learns goes out in its messages.
class Tracker {
 public:
  // `sensor` must outlive the tracker.
  Tracker(const Sensor& sensor, const TrackingOptions& options, const ObjectOptions& objects = {});

  struct Result {
    TrackedFrame frame;
    std::optional<KeyframeRequest> request;
  };

  // Frames come in order of time; `map` is the newest snapshot, null before there is one.
  Result Process(std::shared_ptr<const Frame> frame, std::shared_ptr<const Map> map,
                 const MapperStatus& mapper);

  const StageTimes& times() const { return times_; }

 private:
  // A pose of the frame with the landmarks that were found.
  struct Estimate {
    Rigid3 cam_from_world;
    std::vector<LandmarkId> landmarks;  // one a keypoint
    int inliers = 0;
    int objects = 0;          // that held the pose
    int unknown_objects = 0;  // detections that show no mapped object, where objects hold poses
  };
  static constexpr size_t kObjectSupport = 5;  // landmarks that an object stands for
  static int Support(const Estimate& estimate);
  // With the default of 30 inliers: 20 and 15 matches, 10 inliers (Mur-Artal and Tardos 2017).
  size_t MinMotionMatches() const { return static_cast<size_t>(options_.min_inliers) * 2 / 3; }
  size_t MinReferenceMatches() const { return static_cast<size_t>(options_.min_inliers) / 2; }
  int MinStartInliers() const { return options_.min_inliers / 3; }
  // The frame tracked last, with its pose relative to a keyframe.
  struct LastFrame {
    std::shared_ptr<const Frame> frame;
    std::vector<LandmarkId> landmarks;
    KeyframeId reference;
    Rigid3 cam_from_reference;
  };

  Result Initialize();
  void FollowMap();
  std::optional<Estimate> TrackWithMotionModel() const;
  std::optional<Estimate> TrackReferenceKeyframe() const;
  std::optional<Estimate> TrackLocalMap(Estimate estimate);
  std::vector<bool> CountTracked(const Estimate& estimate);
  void SearchLandmarks(std::span<const LandmarkId> landmarks, std::span<const uint8_t> is_excluded,
                       std::vector<bool>& is_known, Estimate& estimate);
  void OptimizePose(Estimate& estimate, std::span<const PoseObject> objects = {}) const;
  std::vector<ObjectId> FindObjects(const Estimate& estimate) const;
  PoseObjects TakePoseObjects(const Estimate& estimate, std::span<const ObjectId> objects) const;
  bool NeedsKeyframe(const Estimate& estimate, const MapperStatus& mapper) const;
  KeyframeRequest MakeRequest(const Estimate& estimate);
  TrackedFrame Remember(const Estimate& estimate);
  TrackedFrame Lose();

  const Sensor& sensor_;
  TrackingOptions options_;
  ObjectOptions object_options_;
  KeyframePolicy policy_;
  StageTimes times_;

  std::shared_ptr<const Frame> frame_;  // the one in work
  std::shared_ptr<const Map> map_;
  LastFrame last_;
  Rigid3 last_from_world_;          // pose of the last frame in the map of now
  std::optional<Rigid3> velocity_;  // cam_from_last_cam
  KeyframeId reference_;
  FrameId last_keyframe_;  // the frame that was made a keyframe last
  SightingCounter sightings_;
};

}  // namespace hullslam
