// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/bow/inverted_index.h"
#include "hullslam/bow/vocabulary.h"
#include "hullslam/map/keyframe.h"
#include "hullslam/map/landmark.h"
#include "hullslam/map/map_tables.h"
#include "hullslam/map/object_landmark.h"
#include "hullslam/map/replacements.h"
#include "hullslam/util/cow_table.h"
#include "hullslam/util/id.h"
#include "hullslam/util/recycling_table.h"

namespace hullslam {

// Keyframes, landmarks and objects by id, with the observations between them. A map is a value:
// Snapshot() returns a copy, which does not change with the original. The functions here keep the
// two ends of every observation consistent. Covisibility, spanning tree and appearance have their
// own files.
class Map {
 public:
  // A map whose keyframes are not indexed by their words.
  Map() = default;
  // `vocabulary` is the one of the words of all frames. If it is null, the index stays empty.
  explicit Map(std::shared_ptr<const Vocabulary> vocabulary) : vocabulary_(std::move(vocabulary)) {}
  // A map that was stored. The tables are not checked; map_files/restored_map.h does this.
  explicit Map(MapTables tables, std::shared_ptr<const Vocabulary> vocabulary = nullptr);

  // A copy of the map. The two share memory until one of them is changed.
  Map Snapshot();
  // The number of snapshots that were taken of this map. A snapshot returns its own number, counted
  // from 1.
  uint32_t revision() const { return revision_; }

  const CowTable<KeyframeId, Keyframe, 1>& keyframes() const { return keyframes_; }
  const RecyclingTable<LandmarkId, Landmark>& landmarks() const { return landmarks_; }
  const CowTable<ObjectId, ObjectLandmark, 4>& objects() const { return objects_; }
  const CowTable<KeyframeId, CulledKeyframe>& culled() const { return culled_; }

  // The runs that added keyframes, in the order in which they began. Empty for a map that was not
  // made by a run.
  const std::vector<Session>& sessions() const { return sessions_; }
  // Frames from session.first_frame on belong to a new session. Throws CheckError unless this is
  // later than all frames of the map and the begin of the last session.
  void BeginSession(Session session);
  // The id after the largest id of a frame in the map, culled keyframes included.
  FrameId NextFrame() const;

  // The keyframes by the words of their frames, for place recognition.
  const InvertedIndex& index() const { return index_; }
  // Null for a map without a vocabulary.
  const std::shared_ptr<const Vocabulary>& vocabulary() const { return vocabulary_; }
  // The bag of words of a frame; empty without a vocabulary.
  BowVector VectorOf(const Frame& frame) const;

  // Also adds the words of the frame to the index. Throws CheckError if the frame has words, but
  // not one per keypoint.
  KeyframeId AddKeyframe(std::shared_ptr<const Frame> frame, const Rigid3& cam_from_world,
                         IslandId island = IslandId(0));
  LandmarkId AddLandmark(const Eigen::Vector3d& position, KeyframeId created_by);

  // False if the keyframe already observes the landmark or the keypoint already shows a landmark.
  bool AddObservation(LandmarkId landmark, KeyframeId keyframe, uint32_t keypoint);
  // Also removes the landmark if its observation weight is then 2 or less.
  void RemoveObservation(LandmarkId landmark, KeyframeId keyframe);

  void EraseLandmark(LandmarkId landmark);
  // Moves the observations of `landmark` to `by` and redirects its id. If a keyframe observes both,
  // only its observation of `by` stays.
  void ReplaceLandmark(LandmarkId landmark, LandmarkId by);
  // The landmark that has replaced `landmark`, or `landmark` itself; invalid if that is erased, or
  // if the replacement was forgotten.
  LandmarkId Resolve(LandmarkId landmark) const;

  // Adds a candidate without observations.
  ObjectId AddObject();
  // Also adds the detection's vote for its class. False if the keyframe already observes the object
  // or the detection already shows an object.
  bool AddObservation(ObjectId object, KeyframeId keyframe, uint32_t detection);
  // Also removes the vote. An object that has no observation left stays, as a candidate.
  void RemoveObservation(ObjectId object, KeyframeId keyframe);
  void EraseObject(ObjectId object);
  // Like ReplaceLandmark. The shape of `by` is kept. It takes the lock and, if it has no name, the
  // name of `object`.
  void ReplaceObject(ObjectId object, ObjectId by);
  ObjectId Resolve(ObjectId object) const;

  // Whether the object was made before the newest session began.
  bool IsOfEarlierSession(ObjectId object) const { return object < objects_of_session_; }

  // Forgets which landmarks and objects were replaced before the snapshot of this revision was
  // taken. To be called when no message with ids of older snapshots can arrive any more. Objects of
  // earlier sessions are not forgotten, because the session is compared with these.
  void ForgetReplaced(uint32_t revision);
  // The number of remembered replacements.
  size_t replaced_count() const { return replaced_landmarks_.size() + replaced_objects_.size(); }

  // Islands are parts of the map between which no relative pose is known: a monocular camera begins
  // a new one when it was lost. Each has a world frame and a unit of length of its own, a spanning
  // tree of its own, and no landmark, object or edge in common with another one. The first island
  // is number 0, and the others have larger numbers the later they were begun. map/islands.h joins
  // and removes islands.
  IslandId BeginIsland();
  // The numbers of islands that were begun in this run, and of those that were joined to an older
  // one. A map of earlier sessions counts as one island.
  size_t islands_begun() const { return island_sizes_.size(); }
  size_t islands_joined() const { return islands_joined_; }
  // The number of keyframes of an island, without culled ones; 0 after the island was joined or
  // removed.
  size_t IslandSize(IslandId island) const;

  // Gives a keyframe another frame and indexes the words of that frame instead of the old ones. The
  // caller adapts the lists of the keyframe that have one entry per keypoint or detection
  // (CompactKeyframe).
  void ReplaceFrame(KeyframeId keyframe, std::shared_ptr<const Frame> frame);

  // Adds a loop edge between two keyframes of the map, unless they already have one.
  void AddLoop(KeyframeId a, KeyframeId b);

  // Removes a keyframe from the map and from the index. It must have a parent. Its children get new
  // parents (see DetachFromTree). Its loop edges become edges of its parent or a covisible
  // keyframe, the one nearest to the other end, so that no later pose graph opens the loops again.
  void CullKeyframe(KeyframeId keyframe);
  // The record of a culled keyframe; null if the keyframe is not culled.
  const CulledKeyframe* FindCulled(KeyframeId keyframe) const { return culled_.Find(keyframe); }
  // The pose of a keyframe, also of a culled one.
  Rigid3 CamFromWorld(KeyframeId keyframe) const;
  // The pose of a camera in the current map, at the current scale of its reference.
  Rigid3 CamFromWorld(const RelativePose& pose) const;
  // Converts `cam_from_world`, a pose in the current map, to a pose relative to a keyframe, which
  // may be culled.
  RelativePose RelativeTo(KeyframeId reference, const Rigid3& cam_from_world) const;
  // Keyframe::scale, also of a culled keyframe. It includes the corrections since the culling.
  double ScaleOf(KeyframeId keyframe) const;
  // The keyframe made of this frame, culled or not.
  std::optional<KeyframeId> KeyframeOfFrame(FrameId frame) const;
  // The keyframes by their frames, culled ones included.
  const CowTable<FrameId, KeyframeId>& keyframes_by_frame() const { return keyframe_of_frame_; }
  // The keyframe itself or, if it is culled, the nearest ancestor that is not. Invalid if that was
  // removed with its island; then the keyframe has no pose.
  KeyframeId NearestAlive(KeyframeId keyframe) const;

  // The weight of the observation of a landmark at this keypoint. It is 2 with depth and 1 without,
  // because an observation with depth constrains all three coordinates, like two observations
  // without depth.
  static int ObservationWeight(const Frame& frame, uint32_t keypoint);

  // The number of corrections that were applied (map/correction.h).
  uint32_t correction_count() const { return correction_count_; }
  void CountCorrection() { ++correction_count_; }

  void SetPose(KeyframeId keyframe, const Rigid3& cam_from_world);
  void SetPosition(LandmarkId landmark, const Eigen::Vector3d& position);
  void CountSightings(LandmarkId landmark, int visible, int found);

  // For the files of this module that keep derived data consistent.
  Keyframe& MutableKeyframe(KeyframeId keyframe) { return keyframes_.Mutable(keyframe); }
  CulledKeyframe& MutableCulledKeyframe(KeyframeId keyframe) { return culled_.Mutable(keyframe); }
  Landmark& MutableLandmark(LandmarkId landmark) { return landmarks_.Mutable(landmark); }
  void MoveToIsland(KeyframeId keyframe, IslandId island);
  void CountJoinedIsland() { ++islands_joined_; }
  // Removes a keyframe that has no observations any more, without its links to others. It has no
  // pose afterwards.
  void RemoveKeyframe(KeyframeId keyframe);
  // State, shape, misfit, counts, name and lock may be written; observations and votes belong to
  // this class.
  ObjectLandmark& MutableObject(ObjectId object) { return objects_.Mutable(object); }

 private:
  void CountInIsland(IslandId island);
  void NoteFrame(FrameId frame, KeyframeId keyframe);
  // Takes a keyframe out of the table and the index. `kept` is its pose from now on.
  void Erase(KeyframeId keyframe, const RelativePose& kept);
  // cam_from_reference with the translation in the current unit of length of its reference.
  Rigid3 AtCurrentScale(const RelativePose& pose) const;

  CowTable<KeyframeId, Keyframe, 1> keyframes_;
  RecyclingTable<LandmarkId, Landmark> landmarks_;
  CowTable<ObjectId, ObjectLandmark, 4> objects_;
  std::shared_ptr<const Vocabulary> vocabulary_;
  InvertedIndex index_;
  Replacements<LandmarkId> replaced_landmarks_;
  Replacements<ObjectId> replaced_objects_;
  ObjectId objects_of_session_ = ObjectId(0);  // the newest session makes objects from this id on
  CowTable<KeyframeId, CulledKeyframe> culled_;
  CowTable<FrameId, KeyframeId> keyframe_of_frame_;  // culled keyframes included
  std::vector<Session> sessions_;
  std::vector<size_t> island_sizes_;  // one entry per island that was begun
  size_t islands_joined_ = 0;
  uint32_t correction_count_ = 0;
  uint32_t revision_ = 0;
};

}  // namespace hullslam
