// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/mapping/mapping_options.h"
#include "hullslam/objects/object_changes.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/stage_timer.h"
#include "map/contradictions.h"
#include "mapping/culling.h"
#include "objects/object_mapper.h"
#include "objects/request_memory.h"
#include "optim/bundle_result.h"

namespace hullslam {

// Owns the live map. It adds keyframes, creates, fuses and culls landmarks, maps objects, and runs
// bundle adjustment.
class Mapper {
 public:
  using Publish = std::function<void(std::shared_ptr<const Map>)>;

  // `sensor` must outlive the mapper. `publish` is called with every snapshot that others
  // should see. `vocabulary` is that of the words of the frames; null if they have none.
  Mapper(const Sensor& sensor, const MappingOptions& options, const ObjectOptions& objects,
         Publish publish, std::shared_ptr<const Vocabulary> vocabulary = nullptr);

  // Begins with a map of earlier sessions, and publishes it if it has keyframes. The keyframes of
  // the messages belong to `session`, which is added to the map with the first of them. To be
  // called at most once, before all other functions.
  void Begin(Map map, Session session);

  // Processes a message. `hurry` (may be null) is requested while an urgent message waits: any but
  // late detections and edits of objects. The mapper then leaves out the steps that are not
  // necessary. An initial map becomes a new island if the map is not empty. Returns false for a
  // correction that was dropped, because the map was corrected since the snapshot.
  bool Process(const MapMessage& message, const Cancellation* hurry);

  // From now on, a keyframe without detections awaits them in a LateDetections, and says nothing
  // about objects until then; or no longer. May be called by any thread.
  void AwaitMasks(bool is_on) { awaits_masks_ = is_on; }

  // From now on, images are far apart (WithWideErrors), so the next keyframes need not show a
  // landmark again; or no longer. May be called by any thread.
  void ExpectWideSteps(bool is_on) { has_wide_steps_ = is_on; }

  // The next five functions are for the end of a run (system/finish_run.h).
  // False for a map of earlier sessions to which no keyframe was added.
  bool HasChangedMap() const { return !session_; }
  // Removes all islands but the main one (map/islands.h), and keeps each of them as a map of its
  // own. These are adjusted as AdjustMap adjusts the main island.
  void SplitIslands(const Cancellation* cancellation);
  // Adjusts the main island, if mapping.final_bundle_adjustment is set, and publishes the map. Does
  // nothing if `cancellation` (may be null) was requested before. If it is requested meanwhile, the
  // adjustment ends early with its current result. `on_progress` is called after each iteration.
  void AdjustMap(const Cancellation* cancellation, const ProgressCallback& on_progress);
  // Makes the metre the unit of length of a monocular map, if objects of known size are mapped.
  void FollowKnownSizesAtEnd() { FollowKnownSizes(true); }
  // Finds the changes of the objects of earlier sessions. Removes objects that are gone or were
  // moved away.
  void FinishObjects();

  // A snapshot of the live map for a stage that needs one of its own, and the keyframe that was
  // added last, unless it has been culled.
  Map Snapshot() { return map_.Snapshot(); }
  std::optional<KeyframeId> NewestKeyframe() const;

  // The changes of objects between the map of earlier sessions and this session, which
  // FinishObjects finds. Empty if there was no such map or no keyframe was added.
  const std::vector<ChangedObject>& object_changes() const { return object_changes_; }
  // The islands that were not joined to the main one, in the order in which they were begun. Each
  // map has one island only. SplitIslands fills it in.
  const std::vector<std::shared_ptr<const Map>>& left_islands() const { return left_islands_; }

  // The number of landmarks that EraseContradictedLandmarks has removed.
  size_t contradicted_landmarks() const { return contradicted_landmarks_; }

  const StageTimes& times() const { return times_; }
  const std::map<ObjectRejection, size_t>& object_rejections() const {
    return object_mapper_.rejections();
  }

 private:
  bool Apply(const InitialMap& initial, const Cancellation* hurry);
  bool Apply(const KeyframeRequest& request, const Cancellation* hurry);
  bool Apply(const MapCorrection& correction, const Cancellation* hurry);
  bool Apply(const LateDetections& late, const Cancellation* hurry);
  bool Apply(const ObjectEdit& edit, const Cancellation* hurry);
  bool AddLate(KeyframeId keyframe, const LateDetections& late);
  void BeginSession();
  std::vector<ChangedObject> FindChanges(const std::set<ObjectId>& left) const;
  ObjectId FindLeft(const ChangedObject& changed) const;
  std::set<ObjectId> SplitReplacedObjects();
  enum class Culling { kNone, kKeyframes };
  void AddEntities(KeyframeId keyframe, const Cancellation* hurry);
  void Improve(KeyframeId keyframe, const Cancellation* hurry, Culling culling);
  void PublishSnapshot();
  void MapObjects(KeyframeId keyframe);
  void AdjustNeighbourhood(KeyframeId keyframe, const Cancellation* hurry);
  void Apply(const BundleResult& result);
  void FollowKnownSizes(bool is_final);
  void RecheckObjects(const std::vector<ObjectId>& objects);

  // The sensor with the errors that suit the present steps, and those of most keyframes.
  const Sensor& SensorNow() const { return has_wide_steps_ ? wide_sensor_ : sensor_; }
  const Sensor& SensorOfRun() const {
    return 2 * wide_keyframes_ > map_.keyframes().size() ? wide_sensor_ : sensor_;
  }

  const Sensor& sensor_;
  const Sensor wide_sensor_;
  MappingOptions options_;
  ObjectOptions object_options_;
  Publish publish_;
  StageTimes times_;
  ObjectMapper object_mapper_;
  Map map_;
  Map former_;  // the map of earlier sessions
  KeyframeId newest_keyframe_;
  std::vector<LandmarkId> recent_;  // new landmarks that CullRecentLandmarks checks
  std::vector<KeyframeId> full_;    // keyframes that CompactOldKeyframes checks, by increasing id
  Contradictions<LandmarkId> contradictions_;
  LandmarkVisits visits_;
  size_t contradicted_landmarks_ = 0;
  size_t sized_keyframes_ = 0;  // views of objects of known size when the scale was last measured
  std::atomic<bool> awaits_masks_ = false;
  std::atomic<bool> has_wide_steps_ = false;
  size_t wide_keyframes_ = 0;       // that came while images were far apart
  RequestMemory late_requests_;     // keyframes that were made of frames with late masks
  std::optional<Session> session_;  // until its first keyframe
  std::vector<ChangedObject> object_changes_;
  std::vector<std::shared_ptr<const Map>> left_islands_;
};

}  // namespace hullslam
