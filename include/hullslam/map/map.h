// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hullslam/map/keyframe.h"
#include "hullslam/map/landmark.h"
#include "hullslam/map/object_landmark.h"
#include "hullslam/util/cow_table.h"
#include "hullslam/util/id.h"

namespace hullslam {

// Keyframes, landmarks and objects by id, with the observations between them. A map is a value:
// Snapshot() gives one that nobody else writes. The edits here keep both ends of every observation
// in step; covisibility, spanning tree and appearance have their own files.
class Map {
 public:
  // A map with the same content that shares its memory until one of the two is written.
  Map Snapshot();

  const CowTable<KeyframeId, Keyframe, 1>& keyframes() const { return keyframes_; }
  const CowTable<LandmarkId, Landmark>& landmarks() const { return landmarks_; }
  const CowTable<ObjectId, ObjectLandmark, 4>& objects() const { return objects_; }

  KeyframeId AddKeyframe(std::shared_ptr<const Frame> frame, const Rigid3& cam_from_world);
  LandmarkId AddLandmark(const Eigen::Vector3d& position, KeyframeId created_by);

  // False where the keyframe observes the landmark already, or the keypoint another landmark.
  bool AddObservation(LandmarkId landmark, KeyframeId keyframe, uint32_t keypoint);
  // Removes the landmark too when too little holds it: support of 2 or less.
  void RemoveObservation(LandmarkId landmark, KeyframeId keyframe);

  void EraseLandmark(LandmarkId landmark);
  // Moves the observations of `landmark` to `by` and redirects its id; where a keyframe observes
  // both only that of `by` stays.
  void ReplaceLandmark(LandmarkId landmark, LandmarkId by);
  // The landmark that now stands for `landmark`; invalid when it is erased.
  LandmarkId Resolve(LandmarkId landmark) const;

  // A candidate that nobody observes yet.
  ObjectId AddObject();
  // Adds the detection's vote for its class too. False where the keyframe observes the object
  // already, or the detection is that of another object.
  bool AddObservation(ObjectId object, KeyframeId keyframe, uint32_t detection);
  // Takes the vote back; the object stays, even without any observation.
  void RemoveObservation(ObjectId object, KeyframeId keyframe);
  void EraseObject(ObjectId object);
  // As ReplaceLandmark; the shape is that of `by`.
  void ReplaceObject(ObjectId object, ObjectId by);
  ObjectId Resolve(ObjectId object) const;

  // Joins two keyframes of the map by a loop edge. Nothing changes if they are joined already.
  void AddLoop(KeyframeId a, KeyframeId b);

  // Takes a keyframe out of the map. It must have a parent: its children go to their best
  // relatives. Its loop edges go to its parent: without them a later pose graph could open the
  // loops again, and an edge of the parent, which is near, closes them as well.
  void CullKeyframe(KeyframeId keyframe);
  // What is kept of a culled keyframe; null for any other.
  const CulledKeyframe* FindCulled(KeyframeId keyframe) const { return culled_.Find(keyframe); }
  // The pose of a keyframe, also of a culled one.
  Rigid3 CamFromWorld(KeyframeId keyframe) const;
  // The pose of a camera in the current map, at the map's current scale.
  Rigid3 CamFromWorld(const RelativePose& pose) const;
  // `cam_from_world`, which is a pose in the current map, relative to a keyframe, also a culled
  // one.
  RelativePose RelativeTo(KeyframeId reference, const Rigid3& cam_from_world) const;
  // Keyframe::scale, also of a culled keyframe: it has followed the corrections since then.
  double ScaleOf(KeyframeId keyframe) const;
  // The keyframe made of this frame, culled or not.
  std::optional<KeyframeId> KeyframeOfFrame(FrameId frame) const;
  // The keyframe itself or, if it is culled, the nearest ancestor that is not.
  KeyframeId NearestAlive(KeyframeId keyframe) const;

  // How many corrections have been applied (map/correction.h).
  uint32_t correction_count() const { return correction_count_; }
  void CountCorrection() { ++correction_count_; }

  void SetPose(KeyframeId keyframe, const Rigid3& cam_from_world);
  void SetPosition(LandmarkId landmark, const Eigen::Vector3d& position);
  void CountSightings(LandmarkId landmark, int visible, int found);

  // For the files of this module that keep derived data in step.
  Keyframe& MutableKeyframe(KeyframeId keyframe) { return keyframes_.Mutable(keyframe); }
  CulledKeyframe& MutableCulledKeyframe(KeyframeId keyframe) { return culled_.Mutable(keyframe); }
  Landmark& MutableLandmark(LandmarkId landmark) { return landmarks_.Mutable(landmark); }
  // State, shape, misfit and counts may be written; observations and votes belong to this class.
  ObjectLandmark& MutableObject(ObjectId object) { return objects_.Mutable(object); }

 private:
  // cam_from_reference with the translation in the map's current unit of length.
  Rigid3 AtCurrentScale(const RelativePose& pose) const;

  CowTable<KeyframeId, Keyframe, 1> keyframes_;
  CowTable<LandmarkId, Landmark> landmarks_;
  CowTable<ObjectId, ObjectLandmark, 4> objects_;
  CowTable<LandmarkId, LandmarkId> replaced_by_;
  CowTable<ObjectId, ObjectId, 16> object_replaced_by_;
  CowTable<KeyframeId, CulledKeyframe> culled_;
  uint32_t correction_count_ = 0;
};

}  // namespace hullslam
