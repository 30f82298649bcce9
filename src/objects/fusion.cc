// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/fusion.h"

#include <algorithm>
#include <cmath>

#include "hullslam/objects/object_view.h"
#include "objects/point_statistics.h"

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

std::vector<Eigen::Vector3d> Centroids(std::span<const ObjectView> views) {
  std::vector<Eigen::Vector3d> centroids;
  for (const ObjectView& view : views) {
    if (!view.detection->points.empty()) {
      centroids.push_back(Centroid(view));
    }
  }
  return centroids;
}

bool MayHaveOneCentroid(const Map& map, const ObjectLandmark& a, const ObjectLandmark& b,
                        const FusionOptions& options) {
  const std::vector<ObjectView> views_a = CollectViews(map, a);
  const std::vector<ObjectView> views_b = CollectViews(map, b);
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
    inside += center.z() > 0.0 && sensor.bounds.Contains(sensor.camera.Project(center)) ? 1 : 0;
  }
  return 2 * inside > seen.observations.size();
}

bool AreOne(const Map& map, const ObjectLandmark& a, const ObjectLandmark& b,
            const FusionOptions& options) {
  if (!a.has_shape || !b.has_shape || !AreNear(a.ellipsoid, b.ellipsoid)) {
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

}  // namespace

std::optional<ObjectId> FindWhole(const Map& map, const Sensor& sensor, ObjectId candidate) {
  const ObjectLandmark& part = map.objects().At(candidate);
  std::optional<ObjectId> whole;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (!whole && id != candidate && object.state == ObjectState::kMapped &&
        object.Label() == part.Label() && AreNear(part.ellipsoid, object.ellipsoid) &&
        SharedKeyframes(part, object) == 0 && ShouldBeSeenWith(map, sensor, part, object)) {
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
  std::vector<ObjectId> ids;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark&) { ids.push_back(id); });
  std::vector<std::pair<ObjectId, ObjectId>> pairs;
  std::vector<bool> is_taken(ids.size(), false);
  for (size_t i = 0; i < ids.size(); ++i) {
    for (size_t j = i + 1; j < ids.size() && !is_taken[i]; ++j) {
      const ObjectLandmark& a = map.objects().At(ids[i]);
      const ObjectLandmark& b = map.objects().At(ids[j]);
      if (is_taken[j] || !AreOne(map, a, b, options)) {
        continue;
      }
      is_taken[i] = is_taken[j] = true;
      const bool keep_first = a.observations.size() >= b.observations.size();
      pairs.emplace_back(keep_first ? ids[i] : ids[j], keep_first ? ids[j] : ids[i]);
    }
  }
  return pairs;
}

}  // namespace hullslam
