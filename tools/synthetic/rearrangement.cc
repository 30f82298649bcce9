// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/rearrangement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/util/check.h"
#include "synthetic/hash_noise.h"
#include "synthetic/object_models.h"
#include "util/hash.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTouch = 0.005;         // metres; a smaller gap counts as contact
constexpr double kGap = 0.02;            // metres between an object and its new neighbours
constexpr double kLargestCarried = 0.5;  // metres, half extent
constexpr double kCameraRoom =
    0.5;  // least distance of the camera from an object in its new place, metres
constexpr double kAnywhere = std::numeric_limits<double>::infinity();
constexpr double kFarthestMove = 3.0;  // metres
constexpr int kLeastObservations = 5;  // least number of views that show an object in its new place

// A box that stands upright, in the world.
struct UprightBox {
  Vector3d centre;
  Vector3d half;
  double yaw = 0.0;

  double bottom() const { return centre.z() - half.z(); }
  double top() const { return centre.z() + half.z(); }
  Vector2d Axis(int index) const {
    const double angle = yaw + 0.5 * std::numbers::pi * index;
    return {std::cos(angle), std::sin(angle)};
  }
  // Half the length of the shadow of the footprint on a line in the direction `axis`.
  double Reach(const Vector2d& axis) const {
    return half.x() * std::abs(axis.dot(Axis(0))) + half.y() * std::abs(axis.dot(Axis(1)));
  }
};

UprightBox MakeBox(const Rigid3& world_from_box, const Vector3d& half) {
  const Eigen::Matrix3d turn = world_from_box.rotation.toRotationMatrix();
  Check(turn(2, 2) > 1.0 - 1e-9, "only upright boxes can be rearranged");
  return {world_from_box.translation, half, std::atan2(turn(1, 0), turn(0, 0))};
}

UprightBox BoxOf(const SceneObject& object) {
  return MakeBox(object.world_from_object, object.half_extents);
}

// Whether the footprints come nearer than `gap`. They do if no side of either footprint separates
// them by `gap`.
bool FootprintsMeet(const UprightBox& a, const UprightBox& b, double gap) {
  const Vector2d offset = (b.centre - a.centre).head<2>();
  const std::array<Vector2d, 4> axes = {a.Axis(0), a.Axis(1), b.Axis(0), b.Axis(1)};
  return std::all_of(axes.begin(), axes.end(), [&](const Vector2d& axis) {
    return std::abs(offset.dot(axis)) < a.Reach(axis) + b.Reach(axis) + gap - 1e-9;
  });
}

bool BoxesMeet(const UprightBox& a, const UprightBox& b, double gap) {
  return a.bottom() < b.top() - 1e-6 && b.bottom() < a.top() - 1e-6 && FootprintsMeet(a, b, gap);
}

// Whether `upper` stands on or in `lower`, like a book on another book or a bear on a couch.
bool Carries(const UprightBox& lower, const UprightBox& upper) {
  return upper.bottom() > lower.bottom() + kTouch && upper.bottom() < lower.top() + kTouch &&
         FootprintsMeet(lower, upper, 0.0);
}

bool StandsOn(const UprightBox& box, const Support& support) {
  const Vector2d centre = box.centre.head<2>();
  return std::abs(box.bottom() - support.height) < kTouch &&
         (centre.array() > support.min.array()).all() &&
         (centre.array() < support.max.array()).all();
}

const Support* FindSupport(const Scene& scene, const UprightBox& box) {
  for (const Support& support : scene.supports) {
    if (StandsOn(box, support)) {
      return &support;
    }
  }
  return nullptr;
}

bool CanBeCarried(const Scene& scene, const SceneObject& object) {
  if (object.IsDynamic() || object.half_extents.maxCoeff() > kLargestCarried) {
    return false;
  }
  const UprightBox box = BoxOf(object);
  return FindSupport(scene, box) != nullptr &&
         std::none_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& other) {
           return other.id != object.id && Carries(box, BoxOf(other));
         });
}

Vector3d InFrameOf(const UprightBox& box, const Vector3d& point) {
  const Vector2d offset = (point - box.centre).head<2>();
  return {offset.dot(box.Axis(0)), offset.dot(box.Axis(1)), point.z() - box.centre.z()};
}

double DistanceTo(const UprightBox& box, const Vector3d& point) {
  return (InFrameOf(box, point).cwiseAbs() - box.half).cwiseMax(0.0).norm();
}

// Whether the line from `eye` to `point` passes through the box. For each pair of opposite sides
// the line is between them in one interval; it passes through the box if the three intervals
// overlap.
bool Hides(const UprightBox& box, const Vector3d& eye, const Vector3d& point) {
  const Vector3d start = InFrameOf(box, eye);
  const Vector3d step = InFrameOf(box, point) - start;
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(step[axis]) < 1e-12) {
      if (std::abs(start[axis]) > box.half[axis]) {
        return false;
      }
      continue;
    }
    const double a = (-box.half[axis] - start[axis]) / step[axis];
    const double b = (box.half[axis] - start[axis]) / step[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave;
}

// Finds new places for objects.
class PlaceFinder {
 public:
  // Keeps references to all arguments except `former`, which are the objects before anything was
  // moved.
  PlaceFinder(const Scene& scene, std::span<const Rigid3> views, std::vector<SceneObject> former,
              RandomStream& random)
      : scene_(scene), views_(views), former_(std::move(former)), random_(random) {
    for (const SceneObject& object : scene.objects) {
      obstacles_.push_back(BoxOf(object));
    }
    for (const Part& part : scene.background) {
      obstacles_.push_back(MakeBox(part.owner_from_part, part.shape.half));
    }
  }

  // A place for an object that is not in the scene, on a support of the same kind (floor or table)
  // as its own, at most `farthest` metres away. Nothing if no place was found.
  std::optional<Rigid3> Find(double farthest, const SceneObject& object) {
    constexpr int kTrials = 3000;
    const UprightBox box = BoxOf(object);
    const Support* support = FindSupport(scene_, box);
    Check(support != nullptr, "only objects that stand on something can be moved");
    for (int trial = 0; trial < kTrials; ++trial) {
      const UprightBox place = RandomPlace(box, support->height > 0.0);
      if ((place.centre - box.centre).norm() <= farthest && IsFree(object, place) &&
          CountKeyframes(place) >= kLeastObservations) {
        return TurnAboutZ(place.yaw, place.centre);
      }
    }
    return std::nullopt;
  }

 private:
  UprightBox RandomPlace(UprightBox box, bool on_table) {
    std::vector<const Support*> supports;
    for (const Support& support : scene_.supports) {
      if ((support.height > 0.0) == on_table) {
        supports.push_back(&support);
      }
    }
    const Support& support =
        *supports[static_cast<size_t>(random_.Index(static_cast<int>(supports.size())))];
    box.yaw = random_.Uniform(-std::numbers::pi, std::numbers::pi);
    const Vector2d reach(box.Reach(Vector2d::UnitX()), box.Reach(Vector2d::UnitY()));
    const Vector2d low = support.min + reach;
    const Vector2d high = support.max - reach;
    box.centre.x() = random_.Uniform(low.x(), high.x());
    box.centre.y() = random_.Uniform(low.y(), high.y());
    box.centre.z() = support.height + box.half.z();
    return box;
  }

  // Whether the place is free, and is not near a former place of an object of the same class.
  bool IsFree(const SceneObject& object, const UprightBox& place) const {
    const double least = LeastMove(object);
    const auto confuses = [&](const SceneObject& other) {
      return other.class_id == object.class_id &&
             (other.world_from_object.translation - place.centre).head<2>().norm() < least;
    };
    return std::none_of(former_.begin(), former_.end(), confuses) && FitsOnSupport(place) &&
           std::none_of(obstacles_.begin(), obstacles_.end(),
                        [&](const UprightBox& box) { return BoxesMeet(box, place, kGap); }) &&
           std::all_of(views_.begin(), views_.end(), [&](const Rigid3& world_from_cam) {
             return DistanceTo(place, world_from_cam.translation) > kCameraRoom;
           });
  }

  // Whether the whole footprint is on one support. This is never so if the support is smaller than
  // the object.
  bool FitsOnSupport(const UprightBox& place) const {
    const Vector2d reach(place.Reach(Vector2d::UnitX()), place.Reach(Vector2d::UnitY()));
    const Vector2d centre = place.centre.head<2>();
    return std::any_of(scene_.supports.begin(), scene_.supports.end(), [&](const Support& support) {
      return StandsOn(place, support) && ((centre - reach).array() >= support.min.array()).all() &&
             ((centre + reach).array() <= support.max.array()).all();
    });
  }

  // The number of views in which the centre of the box is in the middle part of the image, near
  // enough for the depth sensor, and not hidden.
  int CountKeyframes(const UprightBox& place) const {
    int count = 0;
    for (const Rigid3& world_from_cam : views_) {
      const Vector3d in_cam = Inverse(world_from_cam) * place.centre;
      const bool in_image = in_cam.z() > 0.6 && in_cam.z() < 3.5 &&
                            std::abs(in_cam.x()) < 0.5 * in_cam.z() &&
                            std::abs(in_cam.y()) < 0.38 * in_cam.z();
      count += in_image && IsInSight(world_from_cam.translation, place.centre) ? 1 : 0;
    }
    return count;
  }

  bool IsInSight(const Vector3d& eye, const Vector3d& point) const {
    return std::none_of(obstacles_.begin(), obstacles_.end(),
                        [&](const UprightBox& box) { return Hides(box, eye, point); });
  }

  const Scene& scene_;
  std::span<const Rigid3> views_;
  std::vector<SceneObject> former_;
  RandomStream& random_;
  std::vector<UprightBox> obstacles_;
};

// The ids of all objects that can be carried, in random order.
std::vector<int> ShuffledCarriables(const Scene& scene, RandomStream& random) {
  std::vector<int> ids;
  for (const SceneObject& object : scene.objects) {
    if (CanBeCarried(scene, object)) {
      ids.push_back(object.id);
    }
  }
  for (size_t i = ids.size(); i > 1; --i) {
    std::swap(ids[i - 1], ids[static_cast<size_t>(random.Index(static_cast<int>(i)))]);
  }
  return ids;
}

SceneObject TakeOut(int id, Scene& scene) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [&](const SceneObject& object) { return object.id == id; });
  Check(found != scene.objects.end(), "no object has this id");
  SceneObject object = *found;
  scene.objects.erase(found);
  return object;
}

// Inserts the object into the list, which is sorted by id.
void PutIn(SceneObject object, Scene& scene) {
  const auto next = std::find_if(scene.objects.begin(), scene.objects.end(),
                                 [&](const SceneObject& other) { return other.id > object.id; });
  scene.objects.insert(next, std::move(object));
}

// A copy in other colours.
SceneObject MakeVariant(SceneObject object) {
  for (Part& part : object.parts) {
    const Eigen::Vector3f tint = part.material.tint;
    part.material.tint = {tint.y(), tint.z(), 0.8F * tint.x()};
    part.material.offset += Eigen::Vector3f::Constant(0.37F);
  }
  return object;
}

}  // namespace

double LeastMove(const SceneObject& object) {
  return std::max(0.15, 2.0 * object.half_extents.maxCoeff());
}

bool Collide(const SceneObject& a, const SceneObject& b, double gap) {
  return BoxesMeet(BoxOf(a), BoxOf(b), gap);
}

void Rearrange(std::span<const Rigid3> views, uint64_t seed, Scene& scene) {
  RandomStream random(HashSeed(seed, 0, "rearrange"));
  const std::vector<SceneObject> former = scene.objects;
  const std::vector<int> carriable = ShuffledCarriables(scene, random);
  const size_t count = std::max(size_t{2}, carriable.size() / 5);
  Check(carriable.size() >= 2 * count, "the scene has too few objects that can be moved");
  for (size_t i = 0; i < count; ++i) {
    scene.gone.push_back(TakeOut(carriable[i], scene));
  }
  size_t moved = 0;
  for (size_t i = count; i < carriable.size() && moved < count; ++i) {
    SceneObject object = TakeOut(carriable[i], scene);
    if (const auto pose = PlaceFinder(scene, views, former, random).Find(kFarthestMove, object)) {
      object.status = ObjectStatus::kMoved;
      object.former_world_from_object = object.world_from_object;
      object.world_from_object = *pose;
      ++moved;
    }
    PutIn(std::move(object), scene);
  }
  // Begins at the end of the list, so that copies of moved objects come last.
  size_t added = 0;
  for (size_t i = carriable.size(); i > count && added < count; --i) {
    SceneObject object = MakeVariant(former[static_cast<size_t>(carriable[i - 1])]);
    if (const auto pose = PlaceFinder(scene, views, former, random).Find(kAnywhere, object)) {
      object.status = ObjectStatus::kNew;
      object.id = static_cast<int>(former.size() + added);
      object.world_from_object = *pose;
      ++added;
      PutIn(std::move(object), scene);
    }
  }
  Check(moved >= 2 && added >= 2, "the scene has no free places for objects");
}

}  // namespace hullslam::synthetic
