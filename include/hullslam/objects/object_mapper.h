// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/objects/rejection.h"
#include "hullslam/objects/validity.h"

namespace hullslam {

// The life of objects in a map, one keyframe after the other: association, candidates,
// initialisation, refinement, validity, fusion, culling. It moves no pose and no landmark.
class ObjectMapper {
 public:
  // `sensor` must outlive the mapper.
  ObjectMapper(const Sensor& sensor, const ObjectOptions& options);

  // To be called once a keyframe, when it is in the map with its landmarks.
  void Process(Map& map, KeyframeId keyframe);

  // Checks the objects after their quadrics or the poses have been moved, by bundle adjustment say:
  // what has turned bad goes back to candidate, what is still good has its misfit measured.
  void Recheck(Map& map, std::span<const ObjectId> objects);

  // Seeks the shapes of objects that others have been merged into (map/correction.h).
  void RefineMerged(Map& map, std::span<const ObjectId> objects);

  // How often an object was not mapped, or mapped no longer, for each reason.
  const std::map<ObjectRejection, size_t>& rejections() const { return rejections_; }

 private:
  void Observe(Map& map, KeyframeId keyframe);
  void CountVisible(Map& map, KeyframeId keyframe) const;
  void Update(Map& map, ObjectId id);
  void Start(Map& map, ObjectId id, std::span<const ObjectView> views);
  void Refine(Map& map, ObjectId id, std::span<const ObjectView> views);
  void Accept(Map& map, ObjectId id, std::span<const ObjectView> views) const;
  Objection FewViews(const ObjectLandmark& object) const;
  void FuseDuplicates(Map& map);
  void CullSeldomSeen(Map& map, KeyframeId keyframe);
  void Reject(Map& map, ObjectId id, const Objection& objection);

  const Sensor& sensor_;
  ObjectOptions options_;
  std::map<ObjectRejection, size_t> rejections_;
};

}  // namespace hullslam
