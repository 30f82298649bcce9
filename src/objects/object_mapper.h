// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "map/contradictions.h"
#include "objects/validity.h"

namespace hullslam {

class ObjectIndex;

// Maps objects from one keyframe after the other: association, initialisation, refinement, checks
// of validity, fusion and culling. It changes no pose, no landmark and no shape that a user has
// locked (ObjectLandmark::IsFixed).
class ObjectMapper {
 public:
  // `sensor` must outlive the mapper.
  ObjectMapper(const Sensor& sensor, const ObjectOptions& options);

  // Objects of earlier sessions, by increasing id, that are not removed for being seldom seen. At
  // the end of the session FindObjectChanges tells whether they are gone.
  void Keep(std::vector<ObjectId> objects) { kept_ = std::move(objects); }

  // To be called once per keyframe, after the keyframe and its landmarks were added to the map.
  void Process(Map& map, KeyframeId keyframe);

  // Checks objects after their quadrics or the poses were changed, for example by bundle
  // adjustment. An object that is no longer valid becomes a candidate. The misfit of the others is
  // measured.
  void Recheck(Map& map, std::span<const ObjectId> objects);

  // To be called after a correction of the map (map/correction.h). Finds the shapes of the objects
  // that other objects were merged into.
  void RefineMerged(Map& map, std::span<const ObjectId> objects);

  // For a map of earlier sessions, at the end of a session whose frames have the id `session` or a
  // larger one. A new thing may stand where another one stood before, and its detections may have
  // been associated with the old object. So the session's observations of `object` with another
  // class than before are moved to a new object, whose shape is computed. `former` is the object
  // before the session. Returns whether there are such observations.
  bool SplitOff(Map& map, ObjectId object, const ObjectLandmark& former, FrameId session);

  // The number of rejections of objects, by reason.
  const std::map<ObjectRejection, size_t>& rejections() const { return rejections_; }

 private:
  void Observe(Map& map, const ObjectIndex& index, KeyframeId keyframe);
  void CountVisible(Map& map, const ObjectIndex& index, KeyframeId keyframe) const;
  enum class Copies { kFuse, kKeep };  // of mapped objects
  void Update(Map& map, ObjectId id, Copies copies = Copies::kFuse);
  void Start(Map& map, ObjectId id, std::span<const ResolvedObservation> observations,
             Copies copies);
  void Refine(Map& map, ObjectId id, std::span<const ResolvedObservation> observations);
  void Accept(Map& map, ObjectId id, std::span<const ResolvedObservation> observations) const;
  size_t NeededKeyframes(const ObjectLandmark& object) const;
  Objection FewKeyframes(const ObjectLandmark& object) const;
  void FuseDuplicates(Map& map, KeyframeId keyframe);
  void Fuse(Map& map, ObjectId duplicate, ObjectId kept);
  std::vector<ObjectId> TakeChanged(const Map& map, KeyframeId keyframe);
  std::optional<Objection> ReasonToCull(const Map& map, KeyframeId keyframe, ObjectId id);
  void Cull(Map& map, KeyframeId keyframe);
  void Reject(Map& map, ObjectId id, const Objection& objection);

  const Sensor& sensor_;
  ObjectOptions options_;
  std::map<ObjectRejection, size_t> rejections_;
  // The objects that may have changed since the last search for duplicates, in any order.
  std::vector<ObjectId> changed_;
  std::vector<ObjectId> kept_;  // by increasing id
  Contradictions<ObjectId> contradictions_;
  bool may_all_have_changed_ = true;
};

}  // namespace hullslam
