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

// Maps objects from one keyframe after the other: association, initialisation, refinement, checks
// of validity, fusion and culling. It changes no pose and no landmark.
class ObjectMapper {
 public:
  // `sensor` must outlive the mapper.
  ObjectMapper(const Sensor& sensor, const ObjectOptions& options);

  // To be called once per keyframe, after the keyframe and its landmarks were added to the map.
  void Process(Map& map, KeyframeId keyframe);

  // Checks objects after their quadrics or the poses were changed, for example by bundle
  // adjustment. An object that is no longer valid becomes a candidate. The misfit of the others is
  // measured.
  void Recheck(Map& map, std::span<const ObjectId> objects);

  // Finds the shapes of objects after other objects were merged into them (map/correction.h).
  void RefineMerged(Map& map, std::span<const ObjectId> objects);

  // How often an object was rejected, for each reason.
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
