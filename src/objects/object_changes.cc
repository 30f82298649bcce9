// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_changes.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <span>

#include "geometry/assignment.h"
#include "geometry/polygon_overlap.h"
#include "objects/resolved_observation.h"
#include "objects/visibility.h"

namespace hullslam {
namespace {

// The object's ellipsoid after the corrections of the map since then.
Ellipsoid InMap(const Map& map, const Map& former, const ObjectLandmark& object) {
  const KeyframeId keyframe = object.reference;
  const Sim3 change(map.ScaleOf(keyframe) / former.ScaleOf(keyframe),
                    Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
  return Inverse(Sim3(map.CamFromWorld(keyframe))) * change * Sim3(former.CamFromWorld(keyframe)) *
         object.ellipsoid;
}

// Whether a detection with this label may show the object.
bool MayBe(const ObjectLandmark& object, const std::string& label) {
  constexpr double kLeastShare = 0.2;
  double all = 0.0;
  for (const auto& [name, votes] : object.votes) {
    all += votes;
  }
  const auto same = object.votes.find(label);
  return same != object.votes.end() && same->second >= kLeastShare * all;
}

// The difference of the sizes of two objects: the larger one of the ratios of their two longest
// half axes. The shortest half axis of flat things is not known precisely.
double SizeRatio(Eigen::Vector3d a, Eigen::Vector3d b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a.cwiseQuotient(b).cwiseMax(b.cwiseQuotient(a)).tail<2>().maxCoeff();
}

class Comparison {
 public:
  Comparison(const Map& former, const Map& map, FrameId session, const Sensor& sensor,
             const ObjectOptions& options)
      : former_(former), map_(map), sensor_(sensor), options_(options) {
    for (const auto& [id, keyframe] : map.keyframes()) {
      if (!keyframe.frame->detections.empty()) {
        (keyframe.frame->id < session ? earlier_ : later_).push_back(id);
      }
    }
  }

  std::vector<ChangedObject> Run() {
    if (later_.empty()) {
      return {};
    }
    std::vector<ChangedObject> changed;
    for (const auto& [id, object] : former_.objects()) {
      if (object.state == ObjectState::kMapped) {
        changed.push_back(CompareFormer(id, object));
      }
    }
    for (const auto& [id, object] : map_.objects()) {
      if (object.state == ObjectState::kMapped && !WasMapped(id) && !successors_.contains(id)) {
        changed.push_back(CompareAdded(id, object));
      }
    }
    FindMoved(changed);
    return changed;
  }

 private:
  ChangedObject CompareFormer(ObjectId id, const ObjectLandmark& former) {
    ChangedObject changed{.label = former.Label()};
    const ObjectId now = map_.Resolve(id);
    ObjectLandmark sought = former;
    sought.ellipsoid = InMap(map_, former_, former);
    changed.former = {id, sought.ellipsoid};
    CountKeyframes(later_, now, sought, changed);
    changed.change = Judge(changed, ObjectChange::kGone, ObjectChange::kNotSeen);
    if (changed.change != ObjectChange::kGone) {
      changed.now = Locate(now);
    }
    if (changed.change == ObjectChange::kSeenAgain && !changed.now) {
      changed.now = Locate(FindSuccessor(sought));
      changed.change = changed.now ? ObjectChange::kSeenAgain : ObjectChange::kGone;
    }
    return changed;
  }

  std::optional<LocatedObject> Locate(ObjectId id) const {
    const ObjectLandmark* const object = map_.objects().Find(id);
    return object != nullptr && object->has_shape
               ? std::optional(LocatedObject{id, object->ellipsoid})
               : std::nullopt;
  }

  // The new object at the location of one that was removed from the map although it was seen again.
  // Invalid if there is none.
  ObjectId FindSuccessor(const ObjectLandmark& removed) {
    for (const auto& [id, object] : map_.objects()) {
      const Ellipsoid& shape = object.ellipsoid;
      const double distance =
          (shape.world_from_object.translation - removed.ellipsoid.world_from_object.translation)
              .norm();
      if (object.state == ObjectState::kMapped && !WasMapped(id) &&
          MayBe(removed, object.Label()) && distance <= removed.ellipsoid.half_axes.maxCoeff() &&
          successors_.insert(id).second) {
        return id;
      }
    }
    return {};
  }

  ChangedObject CompareAdded(ObjectId id, const ObjectLandmark& object) {
    ChangedObject changed{.label = object.Label(), .now = LocatedObject{id, object.ellipsoid}};
    CountKeyframes(earlier_, id, object, changed);
    changed.change = Judge(changed, ObjectChange::kNew, ObjectChange::kFirstSeen);
    if (changed.change == ObjectChange::kSeenAgain) {
      changed.change = ObjectChange::kFirstSeen;  // it was seen, but was not mapped
    }
    return changed;
  }

  ObjectChange Judge(const ChangedObject& changed, ObjectChange if_absent,
                     ObjectChange if_unknown) const {
    const ChangeOptions& limits = options_.changes;
    if (changed.expected < limits.min_keyframes) {
      return changed.found > 0 ? ObjectChange::kSeenAgain : if_unknown;
    }
    return changed.found < limits.max_found_ratio * changed.expected ? if_absent
                                                                     : ObjectChange::kSeenAgain;
  }

  void CountKeyframes(std::span<const KeyframeId> keyframes, ObjectId id, ObjectLandmark object,
                      ChangedObject& changed) const {
    std::erase_if(object.observations, [&](const ObjectObservation& observation) {
      return !map_.keyframes().Contains(observation.keyframe);
    });
    for (const KeyframeId keyframe : keyframes) {
      const bool is_found = Shows(map_.keyframes().At(keyframe), id, object);
      if (is_found || IsSeenWithout(keyframe, id, object)) {
        ++changed.expected;
        changed.found += is_found ? 1 : 0;
      }
    }
  }

  // Whether a keyframe that does not show the object shows its location.
  bool IsSeenWithout(KeyframeId id, ObjectId object_id, const ObjectLandmark& object) const {
    const Keyframe& keyframe = map_.keyframes().At(id);
    const ChangeOptions& limits = options_.changes;
    return IsReplaced(keyframe, object_id, object) ||
           SeesThrough(sensor_, *keyframe.frame, keyframe.cam_from_world, object.ellipsoid,
                       limits.min_seen_through) ||
           FindVisibility(map_, sensor_, id, object, options_, limits.min_inside) ==
               LocationVisibility::kVisible;
  }

  // Whether the keyframe shows another thing at the location of the object, or in front of it. The
  // other thing is a new object of another class, or it was associated with the object itself.
  bool IsReplaced(const Keyframe& keyframe, ObjectId id, const ObjectLandmark& object) const {
    for (size_t i = 0; i < keyframe.objects.size(); ++i) {
      const ObjectId shown = keyframe.objects[i];
      if (!shown.IsValid() || MayBe(object, keyframe.frame->detections[i].label)) {
        continue;
      }
      const ObjectLandmark& other = map_.objects().At(shown);
      if (shown == id ||
          (other.state == ObjectState::kMapped && !WasMapped(shown) &&
           other.ellipsoid.RadialDistance(object.ellipsoid.world_from_object.translation) < 0.0)) {
        return true;
      }
    }
    return false;
  }

  // Whether a detection of the keyframe shows the object, or a thing of its class at its location.
  bool Shows(const Keyframe& keyframe, ObjectId id, const ObjectLandmark& object) const {
    const auto ellipse =
        ProjectEllipsoid(sensor_.camera.Matrix(), keyframe.cam_from_world, object.ellipsoid);
    if (!ellipse) {
      return false;
    }
    const std::vector<Eigen::Vector2d> projected = ellipse->Polygon();
    for (size_t i = 0; i < keyframe.objects.size(); ++i) {
      const Detection& detection = keyframe.frame->detections[i];
      if (!MayBe(object, detection.label)) {
        continue;
      }
      if (keyframe.objects[i] == id && id.IsValid()) {
        return true;
      }
      if (!WasMapped(keyframe.objects[i]) &&
          IntersectionOverUnion(projected, detection.hull) >= options_.changes.min_overlap &&
          IsThere(keyframe, detection, object)) {
        return true;
      }
    }
    return false;
  }

  bool WasMapped(ObjectId id) const {
    const ObjectLandmark* const former = former_.objects().Find(id);
    return former != nullptr && former->state == ObjectState::kMapped;
  }

  // Whether the depth of the detection, if there is any, is that of the object.
  static bool IsThere(const Keyframe& keyframe, const Detection& detection,
                      const ObjectLandmark& object) {
    if (detection.points.empty()) {
      return true;
    }
    const Eigen::Vector3d center = Centroid({KeyframeId(), keyframe.cam_from_world, &detection});
    return (center - object.ellipsoid.world_from_object.translation).norm() <=
           object.ellipsoid.half_axes.maxCoeff();
  }

  // Pairs objects that are gone with new ones of the same class and size.
  void FindMoved(std::vector<ChangedObject>& changed) const {
    std::vector<size_t> gone;
    std::vector<size_t> added;
    for (size_t i = 0; i < changed.size(); ++i) {
      if (changed[i].change == ObjectChange::kGone) {
        gone.push_back(i);
      } else if (changed[i].change == ObjectChange::kNew || WasHidden(changed[i])) {
        added.push_back(i);
      }
    }
    Eigen::MatrixXd cost(gone.size(), added.size());
    for (size_t i = 0; i < gone.size(); ++i) {
      for (size_t j = 0; j < added.size(); ++j) {
        cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            MovingCost(changed[gone[i]], changed[added[j]]);
      }
    }
    const std::vector<int> partners = AssignMinimumCost(cost, kNever);
    std::vector<size_t> used;
    for (size_t i = 0; i < gone.size(); ++i) {
      if (partners[i] >= 0) {
        const size_t partner = added[static_cast<size_t>(partners[i])];
        changed[gone[i]].change = ObjectChange::kMoved;
        changed[gone[i]].now = changed[partner].now;
        used.push_back(partner);
      }
    }
    std::sort(used.begin(), used.end(), std::greater<>());
    for (const size_t i : used) {
      changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  // Whether earlier sessions looked towards the location of an object, but something hid it.
  bool WasHidden(const ChangedObject& added) const {
    if (added.change != ObjectChange::kFirstSeen || added.found > 0) {
      return false;
    }
    const ObjectLandmark& object = map_.objects().At(added.now->object);
    const auto hidden = std::count_if(earlier_.begin(), earlier_.end(), [&](KeyframeId id) {
      return FindVisibility(map_, sensor_, id, object, options_, options_.changes.min_inside) ==
             LocationVisibility::kHidden;
    });
    return hidden >= options_.changes.min_keyframes;
  }

  // The map cannot distinguish two cups. So the nearest new object of the same class and about the
  // same size counts as the moved one, if it is not too far away.
  double MovingCost(const ChangedObject& gone, const ChangedObject& added) const {
    const Ellipsoid& from = gone.former->ellipsoid;
    const Ellipsoid& to = added.now->ellipsoid;
    const double ratio = SizeRatio(from.half_axes, to.half_axes);
    const double distance =
        (from.world_from_object.translation - to.world_from_object.translation).norm();
    if (gone.label != added.label || ratio > options_.changes.max_size_ratio ||
        distance > options_.changes.max_move) {
      return kNever;
    }
    // A location that was seen empty before is more likely.
    const double doubt = added.change == ObjectChange::kNew ? 0.0 : 1.0;
    return std::log(ratio) + distance / options_.changes.max_move + doubt;
  }

  static constexpr double kNever = 1e3;

  const Map& former_;
  const Map& map_;
  const Sensor& sensor_;
  const ObjectOptions& options_;
  std::vector<KeyframeId> earlier_;
  std::vector<KeyframeId> later_;  // those of the session
  std::set<ObjectId> successors_;  // those that FindSuccessor has found
};

}  // namespace

std::string_view ToString(ObjectChange change) {
  switch (change) {
    case ObjectChange::kSeenAgain:
      return "seen_again";
    case ObjectChange::kMoved:
      return "moved";
    case ObjectChange::kGone:
      return "gone";
    case ObjectChange::kNew:
      return "new";
    case ObjectChange::kNotSeen:
      return "not_seen";
    default:
      return "first_seen";
  }
}

std::vector<ChangedObject> FindObjectChanges(const Map& former, const Map& map, FrameId session,
                                             const Sensor& sensor, const ObjectOptions& options) {
  return Comparison(former, map, session, sensor, options).Run();
}

}  // namespace hullslam
