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
#include "geometry/polygon.h"
#include "objects/resolved_observation.h"
#include "objects/visibility.h"
#include "util/statistics.h"

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

// Whether the object has been seen as this class often enough.
bool HasClass(const ObjectLandmark& object, const std::string& label) {
  constexpr double kLeastShare = 0.2;
  double all = 0.0;
  for (const auto& [name, votes] : object.votes) {
    all += votes;
  }
  const auto same = object.votes.find(label);
  return same != object.votes.end() && same->second >= kLeastShare * all;
}

// Whether objects of this map keep their class, so that a thing of another class is another thing.
// Detectors of real images often call the same screen a laptop and a television.
bool AreClassesReliable(const Map& map) {
  constexpr double kMostConfused = 0.05;
  double all = 2.0;  // the votes, and two of which one is wrong: a short session proves little
  double confused = 1.0;
  for (const auto& [id, object] : map.objects()) {
    const std::string& label = object.Label();
    for (const auto& [name, votes] : object.votes) {
      all += votes;
      confused += name != label ? votes : 0.0;
    }
  }
  return confused <= kMostConfused * all;
}

// The probability of at most `found` successes in `count` independent trials.
double ChanceOfAtMost(int found, int count, double probability) {
  double term = std::pow(1.0 - probability, count);  // of no success
  double sum = term;
  for (int k = 1; k <= found; ++k) {
    term *= (count - k + 1.0) / k * probability / (1.0 - probability);
    sum += term;
  }
  return sum;
}

// What the keyframes of some sessions tell about the location of an object.
struct Looks {
  int expected = 0;                    // keyframes that should show the object
  int found = 0;                       // those of them that do
  int replaced = 0;                    // those that show another thing there
  std::vector<SeenSurface> of_object;  // the surfaces that are seen where the object is found
  std::vector<SeenSurface> missed;     // and where it is neither found nor replaced

  // The share of masks that the detector gives for this object. A few looks prove little, so two
  // are added, one of which finds it.
  double Recall() const { return (found + 1.0) / (expected + 2.0); }
};

// The distance of a surface from the near side of an ellipsoid that is usual for an object, m.
struct UsualSurface {
  double median = 0.0;
  double spread = 0.0;  // robust standard deviation
};

UsualSurface SurfaceOf(const Looks& present) {
  if (present.of_object.size() < 3) {
    return {};
  }
  std::vector<double> behind;
  for (const SeenSurface& surface : present.of_object) {
    behind.push_back(surface.behind);
  }
  UsualSurface usual;
  usual.median = Median(behind);
  for (double& value : behind) {
    value = std::abs(value - usual.median);
  }
  usual.spread = 1.4826 * Median(behind);
  return usual;
}

// How much a surface may differ from the usual one and still be that of the object, m. An ellipsoid
// is no more precise than a quarter of its thickness. The surface of a hollow thing varies with the
// view, but what is behind the thing is at least half of the thickness farther away.
double ToleranceOf(const UsualSurface& usual, double thickness) {
  constexpr double kSigmas = 3.0;
  return std::clamp(kSigmas * usual.spread, 0.25 * thickness, 0.5 * thickness);
}

// The number of missed looks that show what is behind the object, instead of its own surface.
int CountBehind(const Looks& looks, const UsualSurface& usual) {
  return static_cast<int>(
      std::count_if(looks.missed.begin(), looks.missed.end(), [&](const SeenSurface& surface) {
        return surface.behind > usual.median + ToleranceOf(usual, surface.thickness);
      }));
}

// Leaves out the looks at what is in front of the object. They tell nothing about it.
Looks WithoutHidden(Looks looks, const UsualSurface& usual) {
  const size_t hidden = std::erase_if(looks.missed, [&](const SeenSurface& surface) {
    return surface.behind < usual.median - ToleranceOf(usual, surface.thickness);
  });
  looks.expected -= static_cast<int>(hidden);
  return looks;
}

// An object whose location is looked at.
struct Sought {
  ObjectId object;          // in the map; invalid if it was removed
  bool was_mapped = false;  // in an earlier session
};

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
             const ObjectOptions& options, const std::set<ObjectId>& left)
      : former_(former), map_(map), sensor_(sensor), options_(options), left_(left) {
    for (const auto& [id, keyframe] : map.keyframes()) {
      if (!keyframe.frame->detections.empty()) {
        (keyframe.frame->id < session ? earlier_ : later_).push_back(id);
      }
    }
    classes_are_reliable_ = AreClassesReliable(former);
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
    const Looks present = Look(earlier_, {now, true}, sought);
    const Looks later = WithoutHidden(Look(later_, {now, true}, sought), SurfaceOf(present));
    const ObjectLandmark* const kept = map_.objects().Find(now);
    const bool is_gone =
        (kept == nullptr || !kept->IsFixed()) && (left_.contains(id) || HasLeft(later, present));
    changed.expected = later.expected;
    changed.found = later.found;
    changed.change = is_gone           ? ObjectChange::kGone
                     : later.found > 0 ? ObjectChange::kSeenAgain
                                       : ObjectChange::kNotSeen;
    if (!is_gone) {
      changed.now = Locate(now);
    }
    if (changed.change == ObjectChange::kSeenAgain && !changed.now) {
      changed.now = Locate(FindSuccessor(sought));
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
    const Looks present = Look(later_, {id, false}, object);
    const Looks earlier = WithoutHidden(Look(earlier_, {id, false}, object), SurfaceOf(present));
    changed.expected = earlier.expected;
    changed.found = earlier.found;
    changed.change = HasLeft(earlier, present) ? ObjectChange::kNew : ObjectChange::kFirstSeen;
    return changed;
  }

  // Whether the object is not where it was seen: `looks` should show it but seldom do, so seldom
  // that the detector cannot have missed it so often, since it found it in `present`, and what is
  // behind the object is seen instead.
  bool HasLeft(const Looks& looks, const Looks& present) const {
    constexpr double kLeastChance = 0.01;
    const ChangeOptions& limits = options_.changes;
    if (looks.expected < limits.min_keyframes ||
        looks.found >= limits.max_found_ratio * looks.expected ||
        ChanceOfAtMost(looks.found, looks.expected, present.Recall()) > kLeastChance) {
      return false;
    }
    if (looks.missed.empty() && present.of_object.empty()) {
      return true;  // too small for its surface to be measured
    }
    const int absent = looks.replaced + CountBehind(looks, SurfaceOf(present));
    return 2 * absent >= looks.expected - looks.found;
  }

  Looks Look(std::span<const KeyframeId> keyframes, const Sought& sought,
             ObjectLandmark object) const {
    std::erase_if(object.observations, [&](const ObjectObservation& observation) {
      return !map_.keyframes().Contains(observation.keyframe);
    });
    Looks looks;
    for (const KeyframeId keyframe : keyframes) {
      AddLook(keyframe, sought, object, looks);
    }
    return looks;
  }

  void AddLook(KeyframeId id, const Sought& sought, const ObjectLandmark& object,
               Looks& looks) const {
    const Keyframe& keyframe = map_.keyframes().At(id);
    const bool is_found = Shows(keyframe, sought.object, object);
    const bool is_replaced = !is_found && IsReplaced(keyframe, sought, object);
    if (!is_found && !is_replaced && !IsSeenWithout(id, object)) {
      return;
    }
    ++looks.expected;
    looks.found += is_found ? 1 : 0;
    looks.replaced += is_replaced ? 1 : 0;
    const auto surface = MeasureSurface(
        map_, sensor_,
        {*keyframe.frame, keyframe.cam_from_world, keyframe.landmarks, keyframe.objects},
        object.ellipsoid);
    if (surface && !is_replaced) {
      (is_found ? looks.of_object : looks.missed).push_back(*surface);
    }
  }

  // Whether a keyframe that does not show the object shows its location.
  bool IsSeenWithout(KeyframeId id, const ObjectLandmark& object) const {
    const Keyframe& keyframe = map_.keyframes().At(id);
    const ChangeOptions& limits = options_.changes;
    return SeesThrough(sensor_, *keyframe.frame, keyframe.cam_from_world, object.ellipsoid,
                       limits.min_seen_through) ||
           FindVisibility(map_, sensor_, id, object, options_, limits.min_inside) ==
               LocationVisibility::kVisible;
  }

  // Whether the keyframe shows another thing at the location of the object, or in front of it. The
  // other thing is an object of another class that was only there in the other sessions, or it was
  // associated with the object itself.
  bool IsReplaced(const Keyframe& keyframe, const Sought& sought,
                  const ObjectLandmark& object) const {
    for (size_t i = 0; i < keyframe.objects.size(); ++i) {
      const ObjectId shown = keyframe.objects[i];
      if (!shown.IsValid() || MayBe(object, keyframe.frame->detections[i].label)) {
        continue;
      }
      const ObjectLandmark& other = map_.objects().At(shown);
      if (shown == sought.object ||
          (other.state == ObjectState::kMapped && WasMapped(shown) != sought.was_mapped &&
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
      const double least = HasClass(object, detection.label) ? options_.changes.min_overlap
                                                             : kLeastOverlapOfOtherClass;
      if (!WasMapped(keyframe.objects[i]) &&
          IntersectionOverUnion(projected, detection.hull) >= least &&
          IsThere(keyframe, detection, object)) {
        return true;
      }
    }
    return false;
  }

  // Whether a thing of this class may be the object.
  bool MayBe(const ObjectLandmark& object, const std::string& label) const {
    return !classes_are_reliable_ || HasClass(object, label);
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
  static constexpr double kLeastOverlapOfOtherClass = 0.5;

  const Map& former_;
  const Map& map_;
  const Sensor& sensor_;
  const ObjectOptions& options_;
  const std::set<ObjectId>& left_;
  std::vector<KeyframeId> earlier_;
  std::vector<KeyframeId> later_;  // those of the session
  std::set<ObjectId> successors_;  // those that FindSuccessor has found
  bool classes_are_reliable_ = true;
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
                                             const Sensor& sensor, const ObjectOptions& options,
                                             const std::set<ObjectId>& left) {
  return Comparison(former, map, session, sensor, options, left).Run();
}

}  // namespace hullslam
