// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/fusion.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "frame/detection/visible_part.h"
#include "geometry/polygon.h"
#include "map/islands.h"
#include "objects/constraint/point_statistics.h"
#include "objects/resolved_observation.h"
#include "util/id_set.h"
#include "util/lists.h"

namespace hullslam {
namespace {

// Whether a world point lies inside the ellipsoid.
bool Contains(const Ellipsoid& ellipsoid, const Eigen::Vector3d& point) {
  return ellipsoid.RadialDistance(point) <= 0.0;
}

double Volume(const Ellipsoid& ellipsoid) { return ellipsoid.half_axes.prod(); }

// Share of a's volume that is in b.
double ShareInside(const Ellipsoid& a, const Ellipsoid& b) {
  constexpr int kSteps = 16;
  int total = 0;
  int inside = 0;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const Eigen::Vector3i cell(i % kSteps, i / kSteps % kSteps, i / (kSteps * kSteps));
    const Eigen::Vector3d unit =
        (cell.cast<double>().array() + 0.5) * (2.0 / kSteps) - 1.0;  // -1 to 1
    if (unit.squaredNorm() > 1.0) {
      continue;
    }
    ++total;
    inside += Contains(b, a.world_from_object * a.half_axes.cwiseProduct(unit).eval()) ? 1 : 0;
  }
  return static_cast<double>(inside) / total;
}

size_t SharedKeyframes(const ObjectLandmark& a, const ObjectLandmark& b) {
  std::vector<KeyframeId> shared;
  std::vector<KeyframeId> of_a;
  std::vector<KeyframeId> of_b;
  for (const ObjectObservation& observation : a.observations) {
    of_a.push_back(observation.keyframe);
  }
  for (const ObjectObservation& observation : b.observations) {
    of_b.push_back(observation.keyframe);
  }
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                        std::back_inserter(shared));
  return shared.size();
}

std::vector<Eigen::Vector3d> Centroids(std::span<const ResolvedObservation> observations) {
  std::vector<Eigen::Vector3d> centroids;
  for (const ResolvedObservation& observation : observations) {
    if (!observation.detection->points.empty()) {
      centroids.push_back(Centroid(observation));
    }
  }
  return centroids;
}

bool MayHaveOneCentroid(const Map& map, const ObjectLandmark& a, const ObjectLandmark& b,
                        const FusionOptions& options) {
  const std::vector<ResolvedObservation> views_a = ResolveObservations(map, a);
  const std::vector<ResolvedObservation> views_b = ResolveObservations(map, b);
  if (views_a.empty() || views_b.empty()) {
    return false;
  }
  const double distance = 0.5 * (MeanDistance(views_a, a.ellipsoid.world_from_object.translation) +
                                 MeanDistance(views_b, b.ellipsoid.world_from_object.translation));
  return MayHaveOneMean(Centroids(views_a), Centroids(views_b), options.alpha,
                        options.centroid_noise * distance);
}

// Whether the distance of the centres is at most the sum of the largest half axes.
bool AreNear(const Ellipsoid& a, const Ellipsoid& b) {
  const Eigen::Vector3d offset = a.world_from_object.translation - b.world_from_object.translation;
  return offset.norm() <= a.half_axes.maxCoeff() + b.half_axes.maxCoeff();
}

// Whether the centre of `other` is in the image of most of the keyframes that observe `seen`.
bool ShouldBeSeenWith(const Map& map, const Sensor& sensor, const ObjectLandmark& seen,
                      const ObjectLandmark& other) {
  size_t inside = 0;
  for (const ObjectObservation& observation : seen.observations) {
    const Eigen::Vector3d center = map.keyframes().At(observation.keyframe).cam_from_world *
                                   other.ellipsoid.world_from_object.translation;
    inside += center.z() > 0.0 && sensor.Sees(sensor.camera.Project(center)) ? 1 : 0;
  }
  return 2 * inside > seen.observations.size();
}

// Whether a mask is where the image should show the ellipsoid, at the depth of the ellipsoid.
bool Covers(const Sensor& sensor, const ResolvedObservation& view, const Ellipsoid& ellipsoid) {
  constexpr double kLeastOverlap = 0.5;
  const auto ellipse = ProjectEllipsoid(sensor.camera.Matrix(), view.cam_from_world, ellipsoid);
  if (!ellipse || view.detection->points.empty() || !Contains(ellipsoid, Centroid(view))) {
    return false;
  }
  const Eigen::AlignedBox2d image(Eigen::Vector2d(sensor.bounds.min_x, sensor.bounds.min_y),
                                  Eigen::Vector2d(sensor.bounds.max_x, sensor.bounds.max_y));
  return IntersectionOverUnion(VisiblePart(ellipse->Polygon(), sensor.camera, image),
                               view.detection->hull) >= kLeastOverlap;
}

// Whether most of the masks of an object cover the ellipsoid of another one.
bool ShowsMostly(const Map& map, const Sensor& sensor, const ObjectLandmark& object,
                 const Ellipsoid& other) {
  const std::vector<ResolvedObservation> views = ResolveObservations(map, object);
  const auto covering =
      std::count_if(views.begin(), views.end(),
                    [&](const ResolvedObservation& view) { return Covers(sensor, view, other); });
  return 2 * static_cast<size_t>(covering) > views.size();
}

bool AreOne(const Map& map, const ObjectLandmark& a, const ObjectLandmark& b,
            const FusionOptions& options) {
  if (!a.has_shape || !b.has_shape || (a.IsFixed() && b.IsFixed()) ||
      !AreNear(a.ellipsoid, b.ellipsoid)) {
    return false;
  }
  const size_t shared = SharedKeyframes(a, b);
  const size_t fewer = std::min(a.observations.size(), b.observations.size());
  if (static_cast<double>(shared) > options.max_shared_keyframes * static_cast<double>(fewer)) {
    return false;
  }
  const double overlap = VolumeOverlap(a.ellipsoid, b.ellipsoid);
  if (shared > 0) {
    return overlap >= options.min_overlap_together;
  }
  const bool in_each_other = Contains(a.ellipsoid, b.ellipsoid.world_from_object.translation) &&
                             Contains(b.ellipsoid, a.ellipsoid.world_from_object.translation);
  return overlap >= options.min_overlap ||
         (in_each_other && MayHaveOneCentroid(map, a, b, options));
}

// The data of an object with a shape that AreNear needs.
struct Ball {
  ObjectId id;
  IslandId island;
  Eigen::Vector3d center;
  double radius = 0.0;
};

// The pairs of near objects of which at least one is in `changed`: the smaller id first, the pairs
// in increasing order. Every changed object is compared with a short record of every other one.
std::vector<std::pair<ObjectId, ObjectId>> FindNearPairs(const Map& map,
                                                         std::span<const ObjectId> changed) {
  std::vector<Ball> balls;
  for (const auto& [id, object] : map.objects()) {
    if (object.has_shape) {
      balls.push_back({id, IslandOf(map, object), object.ellipsoid.world_from_object.translation,
                       object.ellipsoid.half_axes.maxCoeff()});
    }
  }
  std::vector<std::pair<ObjectId, ObjectId>> pairs;
  for (const Ball& one : balls) {
    if (!std::binary_search(changed.begin(), changed.end(), one.id)) {
      continue;
    }
    for (const Ball& other : balls) {
      if (one.id != other.id && one.island == other.island &&
          (one.center - other.center).norm() <= one.radius + other.radius) {
        pairs.push_back(std::minmax(one.id, other.id));
      }
    }
  }
  SortUnique(pairs);
  return pairs;
}

}  // namespace

std::pair<ObjectId, ObjectId> KeptFirst(const Map& map, ObjectId a, ObjectId b) {
  const auto rank = [&](ObjectId id) {
    const ObjectLandmark& object = map.objects().At(id);
    return std::tuple(object.IsFixed(), map.IsOfEarlierSession(id), object.observations.size());
  };
  return rank(a) >= rank(b) ? std::pair(a, b) : std::pair(b, a);
}

std::optional<ObjectId> FindDoubled(const Map& map, const Sensor& sensor, ObjectId candidate,
                                    const FusionOptions& options) {
  const ObjectLandmark& copy = map.objects().At(candidate);
  const auto most_shared =
      options.max_shared_keyframes * static_cast<double>(copy.observations.size());
  std::optional<ObjectId> doubled;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (!doubled && id != candidate && object.state == ObjectState::kMapped &&
        IslandOf(map, object) == IslandOf(map, copy) && AreNear(copy.ellipsoid, object.ellipsoid) &&
        static_cast<double>(SharedKeyframes(copy, object)) <= most_shared &&
        ShowsMostly(map, sensor, copy, object.ellipsoid)) {
      doubled = id;
    }
  });
  return doubled;
}

std::optional<ObjectId> FindWhole(const Map& map, const Sensor& sensor, ObjectId candidate) {
  const ObjectLandmark& part = map.objects().At(candidate);
  std::optional<ObjectId> whole;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (!whole && id != candidate && object.state == ObjectState::kMapped &&
        IslandOf(map, object) == IslandOf(map, part) && AreNear(part.ellipsoid, object.ellipsoid) &&
        object.Label() == part.Label() && SharedKeyframes(part, object) == 0 &&
        ShouldBeSeenWith(map, sensor, part, object)) {
      whole = id;
    }
  });
  return whole;
}

double VolumeOverlap(const Ellipsoid& a, const Ellipsoid& b) {
  const bool a_is_smaller = Volume(a) <= Volume(b);
  const Ellipsoid& smaller = a_is_smaller ? a : b;
  const Ellipsoid& larger = a_is_smaller ? b : a;
  const double shared = ShareInside(smaller, larger) * Volume(smaller);
  return shared / (Volume(a) + Volume(b) - shared);
}

std::vector<std::pair<ObjectId, ObjectId>> FindDuplicates(const Map& map,
                                                          const FusionOptions& options) {
  std::vector<ObjectId> all;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark&) { all.push_back(id); });
  return FindDuplicates(map, all, options);
}

std::vector<std::pair<ObjectId, ObjectId>> FindDuplicates(const Map& map,
                                                          std::span<const ObjectId> changed,
                                                          const FusionOptions& options) {
  std::vector<std::pair<ObjectId, ObjectId>> pairs;
  IdSet<ObjectId> taken;
  for (const auto& [first, second] : FindNearPairs(map, changed)) {
    const ObjectLandmark& a = map.objects().At(first);
    const ObjectLandmark& b = map.objects().At(second);
    if (taken.Contains(first) || taken.Contains(second) || !AreOne(map, a, b, options)) {
      continue;
    }
    taken.Insert(first);
    taken.Insert(second);
    pairs.push_back(KeptFirst(map, first, second));
  }
  return pairs;
}

}  // namespace hullslam
