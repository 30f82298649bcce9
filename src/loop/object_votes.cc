// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/object_votes.h"

#include <algorithm>
#include <vector>

#include "geometry/polygon.h"
#include "objects/visibility.h"
#include "places/similar_places.h"
#include "util/lists.h"

namespace hullslam {
namespace {

// The mapped objects that the keyframe and its neighbours observe, by increasing id.
std::vector<ObjectId> MappedAround(const Map& map, KeyframeId keyframe) {
  std::vector<ObjectId> objects;
  for (const KeyframeId observer : KeyframesAround(map, keyframe)) {
    for (const ObjectId id : map.keyframes().At(observer).objects) {
      if (id.IsValid() && map.objects().At(id).state == ObjectState::kMapped) {
        objects.push_back(id);
      }
    }
  }
  SortUnique(objects);
  return objects;
}

// Whether each of the quadrics, enlarged by half, contains the centre of the other.
bool AreAtOneLocation(const Ellipsoid& a, const Ellipsoid& b) {
  const auto reaches = [](Ellipsoid from, const Ellipsoid& to) {
    from.half_axes *= 1.5;
    return from.RadialDistance(to.world_from_object.translation) <= 0.0;
  };
  return reaches(a, b) && reaches(b, a);
}

// Whether a detection of one object has the same class as a detection of the other.
bool ShareClass(const ObjectLandmark& a, const ObjectLandmark& b) {
  return std::ranges::any_of(a.votes,
                             [&](const auto& vote) { return b.votes.contains(vote.first); });
}

// Whether a mask of the keyframe shows a thing of the object's class at the object's location. Only
// masks that belong to no mapped object count, because all others show that mapped object.
bool IsDetected(const Map& map, const Sensor& sensor, const ObjectLandmark& object,
                KeyframeId keyframe_id, const AssociationOptions& options) {
  const Keyframe& keyframe = map.keyframes().At(keyframe_id);
  const auto ellipse =
      ProjectEllipsoid(sensor.camera.Matrix(), keyframe.cam_from_world, object.ellipsoid);
  if (!ellipse) {
    return false;
  }
  const std::vector<Eigen::Vector2d> projected = ellipse->Polygon();
  for (size_t i = 0; i < keyframe.objects.size(); ++i) {
    const Detection& detection = keyframe.frame->detections[i];
    const ObjectLandmark* const owner = map.objects().Find(keyframe.objects[i]);
    const bool is_mapped = owner != nullptr && owner->state == ObjectState::kMapped;
    if (!is_mapped && object.votes.contains(detection.label) &&
        IntersectionOverUnion(projected, detection.hull) >= options.min_projection_iou) {
      return true;
    }
  }
  return false;
}

enum class Vote { kNone, kAgree, kDisagree };

// The vote of an object of one end, compared with the objects of the other end.
Vote VoteOf(const Map& map, const Sensor& sensor, const ObjectLandmark& object,
            const std::vector<ObjectId>& others, KeyframeId other_end,
            const ObjectOptions& options) {
  bool is_location_taken = false;
  for (const ObjectId id : others) {
    const ObjectLandmark& other = map.objects().At(id);
    if (AreAtOneLocation(object.ellipsoid, other.ellipsoid)) {
      if (ShareClass(object, other)) {
        return Vote::kAgree;
      }
      is_location_taken = true;
    }
  }
  const bool is_missing =
      is_location_taken ||
      (FindVisibility(map, sensor, other_end, object, options) == LocationVisibility::kVisible &&
       !IsDetected(map, sensor, object, other_end, options.association));
  return is_missing ? Vote::kDisagree : Vote::kNone;
}

}  // namespace

ObjectVotes CountObjectVotes(const Map& corrected, const Sensor& sensor, KeyframeId query,
                             KeyframeId candidate, const ObjectOptions& options) {
  const std::vector<ObjectId> at_query = MappedAround(corrected, query);
  const std::vector<ObjectId> at_candidate = MappedAround(corrected, candidate);
  ObjectVotes votes;
  const auto count = [&](const std::vector<ObjectId>& objects, const std::vector<ObjectId>& others,
                         KeyframeId other_end, bool counts_agreement) {
    for (const ObjectId id : objects) {
      const Vote vote =
          VoteOf(corrected, sensor, corrected.objects().At(id), others, other_end, options);
      votes.agree += vote == Vote::kAgree && counts_agreement ? 1 : 0;
      votes.disagree += vote == Vote::kDisagree ? 1 : 0;
    }
  };
  count(at_query, at_candidate, candidate, true);
  count(at_candidate, at_query, query, false);
  return votes;
}

}  // namespace hullslam
