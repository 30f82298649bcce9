// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/tracking/tracking_options.h"
#include "hullslam/util/stage_timer.h"
#include "objects/request_memory.h"
#include "tracking/drift_model.h"
#include "tracking/early_frames.h"
#include "tracking/keyframe_policy.h"
#include "tracking/last_frame.h"
#include "tracking/monocular_initialiser.h"
#include "tracking/odometry_chain.h"
#include "tracking/repeated_views.h"
#include "tracking/shutter_correction.h"
#include "tracking/sources/confirmed_pose.h"
#include "tracking/sources/pose_source.h"
#include "tracking/tracking_context.h"
#include "util/id_set.h"

namespace hullslam {

// Counts, between two messages to the mapper, the frames in which each landmark should have been
// visible and the frames in which it was found.
class SightingCounter {
 public:
  void CountVisible(LandmarkId landmark) { ++counts_[landmark].visible; }
  void CountFound(LandmarkId landmark) { ++counts_[landmark].found; }

  // The counts since the last call, by increasing id. Counting starts again from zero.
  std::vector<Sighting> Take();

 private:
  struct Counts {
    int visible = 0;
    int found = 0;
  };
  IdMap<LandmarkId, Counts> counts_;
};

// Whether the mapper can take a keyframe at the moment.
struct MapperStatus {
  bool is_idle = true;
  int requests_waiting = 0;
};

// Finds the pose of each frame in a snapshot of the map and decides on keyframes. A camera that
// stays lost begins a new island (Map::BeginIsland). The tracker does not change the map;
// it sends messages to the mapper. Its members are its memory from one frame to the next.
class Tracker {
 public:
  // `sensor` must outlive the tracker. `seed` is that of the run.
  Tracker(const Sensor& sensor, const TrackingOptions& options, const ObjectOptions& objects = {},
          uint64_t seed = 0);

  // Whether no keyframe is requested from now on. If so, the next frame must come with a map.
  void LocaliseOnly(bool is_localizing_only = true) { is_localizing_only_ = is_localizing_only; }

  // The pose of the camera in the first image of a new map; by default the identity.
  void BeginAt(const std::optional<Rigid3>& world_from_cam) { start_ = world_from_cam; }

  // Requests tell the mapper to remember which ids have replaced those of snapshots from this
  // revision on (KeyframeRequest::oldest_revision), also if they do not need it themselves.
  void KeepIdsSince(uint32_t revision) { kept_revision_ = revision; }

  struct Result {
    FrameReport report;
    std::optional<MapMessage> message;  // for the mapper: an InitialMap or a KeyframeRequest
  };

  // Frames come in order of time. `map` is the newest snapshot, null before there is one. If the
  // first map is there before the first frame, tracking is lost until a frame is relocalised.
  Result Process(std::shared_ptr<const Frame> frame, std::shared_ptr<const Map> map,
                 const MapperStatus& mapper);

  // To be called when all frames have been processed: a keyframe for the mapper, made of a frame
  // that was lost and is found in the map as it is now. Null if there is none, and if no images
  // were far apart. Is called again with the new map until there is none.
  std::optional<KeyframeRequest> FindLostKeyframe(const Map& map);

  // To be called at the end of a run, with the final map. See EarlyFrames.
  std::vector<TrackedFrame> LocaliseEarlyFrames(const Map& map,
                                                const Cancellation* cancellation = nullptr,
                                                const ProgressCallback& on_progress = {});

  // Whether images are far apart at the moment, so that errors are larger (WithWideErrors): from a
  // frame that only kWideSources found to the next one that needs no keyframe.
  bool HasWideSteps() const { return is_wide_; }

  // Whether wide matches were needed for a frame, or the map was begun more than once.
  bool HasHadWideSteps() const { return MayMatchWidely() && has_had_wide_steps_; }

  const StageTimes& times() const { return times_; }

 private:
  TrackingContext Context() const {
    return is_wide_ ? WideContext()
                    : TrackingContext{sensor_, options_, object_options_, object_index_, seed_};
  }
  TrackingContext WideContext() const {
    return {wide_sensor_, options_, object_options_, object_index_, seed_, true};
  }
  bool MayMatchWidely() const { return options_.wide_matches && !is_localizing_only_; }
  Result Initialize(std::shared_ptr<const Frame> frame);
  MonocularInitialiser::Result FindInitialMap(const std::shared_ptr<const Frame>& frame);
  void KeepEarly(const std::shared_ptr<const Frame>& frame, bool is_tracked);
  Result BeginIsland(std::shared_ptr<const Frame> frame, InitialMap initial);
  Result Track(std::shared_ptr<const Frame> frame, const Map& map, const MapperStatus& mapper);
  // A tracked frame.
  struct Found {
    CorrectedFrame corrected;
    LocalTracking tracking;
    std::optional<CameraMotion> motion;  // from the last frame, if the pose follows from it
    bool is_relocalised = false;
    bool is_wide = false;  // found by kWideSources
    PriorUse prior = PriorUse::kNone;
  };
  std::optional<Found> FindPose(const std::shared_ptr<const Frame>& frame, const Map& map,
                                PoseSearch& search);
  std::optional<Found> FindWithoutPrior(const std::shared_ptr<const Frame>& frame, const Map& map,
                                        PoseSearch& search) const;
  bool FuseAhead(const MotionPrior& ahead, const Frame& frame, const Map& map,
                 std::optional<Found>& found) const;
  std::optional<Result> DeadReckon(const std::shared_ptr<const Frame>& frame, const Map& map,
                                   const MapperStatus& mapper);
  std::optional<Found> FindCorrectedPose(const std::shared_ptr<const Frame>& as_read,
                                         const Map& map, PoseSearch& search) const;
  std::optional<Found> FindCorrectedPose(const std::shared_ptr<const Frame>& as_read,
                                         const std::shared_ptr<const Frame>& tried, const Map& map,
                                         PoseSearch& search) const;
  std::optional<Found> FindWidely(const std::shared_ptr<const Frame>& as_read, const Map& map,
                                  PoseSearch& search) const;
  Result Accept(Found found, const std::shared_ptr<const Frame>& as_read, const Map& map,
                const MapperStatus& mapper);
  Result Lose(std::shared_ptr<const Frame> frame, const Map& map, TrackingFailure reason);
  bool IsYoung(const Map& map) const;
  bool IsTiny(const Map& map) const;
  bool MayBeginIsland(const Frame& frame, const Map& map) const;
  bool NeedsKeyframe(const Frame& frame, const Map& map, const LocalTracking& tracking,
                     const MapperStatus& mapper);
  void CountSightings(const Map& map, const LocalTracking& tracking);
  KeyframeRequest MakeRequest(std::shared_ptr<const Frame> frame, const LocalTracking& tracking,
                              const RelativePose& pose);

  const Sensor& sensor_;
  const Sensor wide_sensor_;
  const IslandRules island_rules_;
  const TrackingOptions options_;
  const ObjectOptions object_options_;
  const uint64_t seed_;
  const KeyframePolicy policy_;
  StageTimes times_;

  MonocularInitialiser initialiser_;
  EarlyFrames early_;

  bool is_localizing_only_ = false;
  std::optional<Rigid3> start_;      // world_from_cam of the first image of a new map
  bool is_wide_ = false;             // see HasWideSteps
  bool has_had_wide_steps_ = false;  // whether they ever were, or the map was begun more than once

  std::optional<double> lost_since_;  // s, time stamp of the first lost frame; absent if not lost
  int lost_frames_ = 0;               // since then; of dead reckoned ones, the last with features
  FrameId first_frame_;               // those of earlier sessions have smaller ids
  std::optional<double> relocalised_at_;  // s, time stamp of the last relocalised frame
  int prior_credit_ = 0;  // number of fused less that of dropped priors of the last frames, bounded
  LastFrame last_;        // has no frame before the first frame with a pose
  // Time stamp of the frame of the last message, s. If there is no message yet, that of the first
  // frame with a pose.
  std::optional<double> last_request_time_;
  OdometryChain odometry_;
  DriftModel drift_;
  SightingCounter sightings_;  // since the last request
  // Map::revision() of the first map in which sightings were counted; absent if there are none.
  std::optional<uint32_t> first_sighting_revision_;
  uint32_t kept_revision_ = UINT32_MAX;  // see KeepIdsSince
  RequestMemory object_requests_;
  JoinRequests join_requests_;
  LastingChanges lasting_changes_;
  ObjectIndex object_index_;  // index of the map of the last frame
};

}  // namespace hullslam
