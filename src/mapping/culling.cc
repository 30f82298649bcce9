// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/culling.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "frame/measure_point.h"
#include "map/compaction.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/keyframe_order.h"
#include "map/landmark_projection.h"
#include "mapping/sensor_rules.h"
#include "objects/constraint/point_statistics.h"
#include "objects/resolved_observation.h"
#include "places/similar_places.h"

namespace hullslam {
namespace {

// A static landmark is contradicted by mistake in at most 2.5 % of the keyframes (one side of the
// bound below), so by three of them once in 60 000 times: less than one landmark in a map.
constexpr int kContradictions = 3;

Sight LookAtLandmark(const Sensor& sensor, const Keyframe& keyframe, const Landmark& landmark) {
  const DepthGrid& grid = keyframe.frame->depth;
  const std::optional<LandmarkProjection> view =
      ProjectLandmark(sensor, keyframe.cam_from_world, landmark);
  return view && !grid.empty() ? LookAt(sensor, grid, view->pixel, view->point_in_cam)
                               : Sight::kUnclear;
}

constexpr uint32_t kYoungKeyframes = 20;

constexpr int kMostAtOnce = 2;  // a map far beyond its bound shrinks while it is used
// Over the bound, half of the landmarks of a keyframe that goes are held by enough others.
constexpr double kLeastShareOverBound = 0.5;

}  // namespace

size_t EraseContradictedLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                                  Contradictions<LandmarkId>& contradictions) {
  const Keyframe& keyframe = map.keyframes().At(current);
  if (keyframe.frame->depth.empty()) {
    return 0;
  }
  size_t erased = 0;
  for (const LandmarkId id : ObservedLandmarks(map, KeyframesAround(map, current))) {
    const Landmark& landmark = map.landmarks().At(id);
    const FrameId last_seen = FrameIdOf(map, LastObserver(map, landmark.observations));
    if (last_seen >= keyframe.frame->id) {
      continue;
    }
    const Sight sight = LookAtLandmark(sensor, keyframe, landmark);
    if (sight == Sight::kSurface) {
      contradictions.Forget(id);
    } else if (sight == Sight::kPast && contradictions.Add(id, last_seen) == kContradictions) {
      contradictions.Forget(id);
      map.EraseLandmark(id);
      ++erased;
    }
  }
  return erased;
}

namespace {

constexpr double kMinFoundRatio = 0.25;
constexpr double kBetweenVisits = 60.0;  // s
constexpr double kMistaken = 0.1;        // share of frames in which others are taken for a landmark
constexpr int kMissedVisits = 3;
constexpr int kPatience = 8;             // visits for each one in which it was found
constexpr int kMostVisits = 50;          // that count
constexpr int kAppearances = 2;          // of a place
constexpr double kSamePoint = 9.0;       // px^2 at level 0
constexpr double kSameDepth = 0.1;       // share; other things hide it
constexpr uint32_t kTrialKeyframes = 2;  // at this age landmarks of small weight are erased
constexpr double kRedundantShare = 0.9;
// Two keyframes see a landmark from the same viewpoint if its parallax between them is smaller than
// this many standard deviations.
constexpr double kSameViewpointSigmas = 2.0;
constexpr double kMaxSimilarCos = 0.985;  // about 10 degrees
constexpr size_t kCenterPoints = 20;      // depth points that are averaged for an object's centre

Eigen::Vector3d RayTo(const Rigid3& cam_from_world, const Eigen::Vector3d& point) {
  return (point - Inverse(cam_from_world).translation).normalized();
}

// Whether enough other keyframes see the landmark. If the rules say so, only keyframes with
// different viewpoints count.
bool IsSeenByOthers(const Map& map, const Landmark& landmark, KeyframeId id, int level,
                    const Sensor& sensor, const CullingRules& rules) {
  const double max_cos = std::cos(kSameViewpointSigmas * std::sqrt(2.0) / sensor.camera.fx);
  std::array<Eigen::Vector3d, CullingRules::kMaxOtherObservers> rays;
  size_t others = 0;
  for (const Observation& observation : landmark.observations) {
    const Keyframe& keyframe = map.keyframes().At(observation.keyframe);
    if (observation.keyframe == id ||
        keyframe.frame->features.keypoints[observation.keypoint].level > level + 1) {
      continue;
    }
    if (rules.observers_need_parallax) {
      rays[others] = RayTo(keyframe.cam_from_world, landmark.position);
      const bool is_same_viewpoint =
          std::any_of(rays.begin(), rays.begin() + others,
                      [&](const Eigen::Vector3d& ray) { return ray.dot(rays[others]) > max_cos; });
      if (is_same_viewpoint) {
        continue;
      }
    }
    if (++others == rules.other_observers) {
      return true;
    }
  }
  return false;
}

// How many landmarks a keyframe has, and how many of them enough other keyframes see too.
struct Redundancy {
  int landmarks = 0;
  int redundant = 0;

  void Count(bool is_redundant) {
    ++landmarks;
    redundant += is_redundant ? 1 : 0;
  }
  double Share() const { return redundant / std::max(1.0, landmarks + 0.0); }
  bool MostAreRedundant() const { return landmarks == 0 || Share() > kRedundantShare; }
};

struct Redundancies {
  Redundancy close;
  Redundancy all;  // landmarks
};

Redundancies CountRedundant(const Map& map, KeyframeId id, const Sensor& sensor,
                            const CullingRules& rules) {
  const Keyframe& keyframe = map.keyframes().At(id);
  const FrameFeatures& features = keyframe.frame->features;
  Redundancies counts;
  for (size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (!keyframe.landmarks[i].IsValid()) {
      continue;
    }
    const Landmark& landmark = map.landmarks().At(keyframe.landmarks[i]);
    const bool is_redundant =
        IsSeenByOthers(map, landmark, id, features.keypoints[i].level, sensor, rules);
    const double depth = static_cast<double>(features.depth[i]);
    counts.all.Count(is_redundant);
    if (depth > 0.0 && depth <= sensor.close_depth) {
      counts.close.Count(is_redundant);
    }
  }
  return counts;
}

bool IsRedundant(const Map& map, KeyframeId id, const Sensor& sensor, const CullingRules& rules) {
  const auto [close, all] = CountRedundant(map, id, sensor, rules);
  if (rules.only_close_landmarks) {
    return close.landmarks > 0 && close.MostAreRedundant();
  }
  const bool has_many_close = close.landmarks >= rules.min_close_landmarks;
  return all.landmarks >= rules.min_landmarks && close.MostAreRedundant() &&
         (has_many_close || all.MostAreRedundant());
}

int CountShared(const Map& map, const Keyframe& a, KeyframeId b) {
  return static_cast<int>(std::ranges::count_if(a.landmarks, [&](LandmarkId id) {
    return id.IsValid() && std::ranges::binary_search(map.landmarks().At(id).observations, b, {},
                                                      &Observation::keyframe);
  }));
}

// Whether the keyframes before and after it share too few landmarks without it. Each landmark may
// be seen by many others and yet none of them see it on both sides.
bool JoinsItsNeighbours(const Map& map, KeyframeId id, int min_shared) {
  const Keyframe& keyframe = map.keyframes().At(id);
  const Keyframe* const before = NextInTime(map, keyframe.frame->id, keyframe.island, -1);
  const Keyframe* const after = NextInTime(map, keyframe.frame->id, keyframe.island, 1);
  if (before == nullptr || after == nullptr) {
    return false;
  }
  const int weakest = std::min(CountShared(map, *before, id), CountShared(map, *after, id));
  return CountShared(map, *before, *map.KeyframeOfFrame(after->frame->id)) <
         std::min(weakest, min_shared);
}

// The centre of the object. Null if it is not known: of a candidate without shape and depth.
std::optional<Eigen::Vector3d> CenterOf(const ObjectLandmark& object,
                                        std::span<const ResolvedObservation> views) {
  if (object.has_shape) {
    return object.ellipsoid.world_from_object.translation;
  }
  const std::vector<Eigen::Vector3d> points = CollectPoints(views, kCenterPoints);
  return points.empty() ? std::nullopt : std::optional(MeanOf(points));
}

// Whether no other keyframe sees the object from a similar direction.
bool IsNewDirection(const Map& map, KeyframeId id, const ObjectLandmark& object) {
  const std::vector<ResolvedObservation> views = ResolveObservations(map, object);
  const std::optional<Eigen::Vector3d> center = CenterOf(object, views);
  if (!center) {
    return false;
  }
  const Eigen::Vector3d ray = RayTo(map.CamFromWorld(id), *center);
  return std::ranges::none_of(views, [&](const ResolvedObservation& view) {
    return view.keyframe != id && RayTo(view.cam_from_world, *center).dot(ray) >= kMaxSimilarCos;
  });
}

// Whether an object has few views (a locked one its last), or none but this one from a direction if
// `directions_count`.
bool IsNeededByAnObject(const Map& map, KeyframeId id, size_t min_views,
                        bool directions_count = true) {
  return std::ranges::any_of(map.keyframes().At(id).objects, [&](ObjectId observed) {
    if (!observed.IsValid()) {
      return false;
    }
    const ObjectLandmark& object = map.objects().At(observed);
    return object.observations.size() <= std::max<size_t>(min_views, object.IsFixed() ? 1 : 0) ||
           (directions_count && IsNewDirection(map, id, object));
  });
}

}  // namespace

void CullRecentLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                         std::vector<LandmarkId>& recent) {
  const IslandId island = IslandOf(map, current);
  const int max_weak = CullingRules::ForSensor(sensor.kind).max_weak_weight;
  std::erase_if(recent, [&](LandmarkId id) {
    const Landmark* landmark = map.landmarks().Find(id);
    if (landmark == nullptr || IslandOf(map, landmark->reference) != island) {
      return true;
    }
    const uint32_t age = AgeOf(map, landmark->created_by, current, kTrialKeyframes + 1);
    const bool is_seldom_found = landmark->found < kMinFoundRatio * landmark->visible;
    const bool is_weak = age >= kTrialKeyframes && landmark->observation_weight <= max_weak;
    if (is_seldom_found || is_weak) {
      map.EraseLandmark(id);
      return true;
    }
    return age > kTrialKeyframes;
  });
}

void LandmarkVisits::Add(const Map& map, const std::vector<Sighting>& sightings, double time) {
  for (const Sighting& sighting : sightings) {
    const LandmarkId id = map.Resolve(sighting.landmark);
    if (!id.IsValid() || sighting.visible == 0) {
      continue;
    }
    Counts& counts = counts_[id];
    counts.missed += begin_ - counts.last > kBetweenVisits ? 1 : 0;
    counts.last = time;
    if (counts.missed > 0 && sighting.found > kMistaken * sighting.visible) {
      ++counts.found;
      counts.missed = 0;
    }
  }
  begin_ = time;
  if (counts_.entries().size() > 2 * map.landmarks().size()) {
    for (const auto& [id, counts] : counts_.Take()) {
      if (map.landmarks().Contains(id)) {
        counts_[id] = counts;
      }
    }
  }
}

size_t EraseForgottenLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                               const LandmarkVisits& visits) {
  std::vector<std::pair<LandmarkId, LandmarkProjection>> expected;
  for (const LandmarkId id : ObservedLandmarks(map, KeyframesAround(map, current))) {
    const Landmark& landmark = map.landmarks().At(id);
    if (const auto view = ProjectLandmark(sensor, map.CamFromWorld(current), landmark)) {
      expected.emplace_back(id, *view);
    }
  }
  size_t forgotten = 0;
  for (const auto& [id, view] : expected) {
    const LandmarkVisits::Counts counts = visits.Of(id);
    const auto sigma2 = static_cast<double>(sensor.levels.sigma2[static_cast<size_t>(view.level)]);
    const auto replaces = [&, view = view](const auto& other) {
      const LandmarkVisits::Counts of_other = visits.Of(other.first);
      const double depths = other.second.point_in_cam.z() / view.point_in_cam.z();
      return of_other.missed < counts.missed && of_other.found > 1 &&
             std::abs(depths - 1.0) < kSameDepth &&
             std::abs(other.second.level - view.level) <= 1 &&
             (other.second.pixel - view.pixel).squaredNorm() < kSamePoint * sigma2;
    };
    if (counts.missed >= kMissedVisits &&
        (counts.missed >= kPatience * std::min(counts.found + 1, kMostVisits) ||
         std::ranges::count_if(expected, replaces) >= kAppearances)) {
      map.EraseLandmark(id);
      ++forgotten;
    }
  }
  return forgotten;
}

std::vector<LandmarkId> FindRecentLandmarks(const Map& map) {
  std::vector<LandmarkId> recent;
  const KeyframeId newest(map.keyframes().NextId().value - 1);
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    // At the next keyframe it is one more.
    if (AgeOf(map, landmark.created_by, newest, kTrialKeyframes + 1) <= kTrialKeyframes) {
      recent.push_back(id);
    }
  });
  return recent;
}

int CullKeyframes(Map& map, KeyframeId current, const Sensor& sensor, size_t min_object_views,
                  MappingRule rule) {
  const CullingRules rules = CullingRules::ForSensor(sensor.kind, rule);
  int culled = 0;
  const std::vector<Covisible> candidates = map.keyframes().At(current).covisible;
  for (const Covisible& candidate : candidates) {
    const Keyframe* keyframe = map.keyframes().Find(candidate.keyframe);
    const bool is_root = keyframe == nullptr || !keyframe->parent.IsValid();
    if (!is_root && IsRedundant(map, candidate.keyframe, sensor, rules) &&
        !JoinsItsNeighbours(map, candidate.keyframe, rules.min_shared) &&
        !IsNeededByAnObject(map, candidate.keyframe,
                            rules.keeps_object_views ? min_object_views : 0,
                            rules.keeps_object_views)) {
      map.CullKeyframe(candidate.keyframe);
      ++culled;
    }
  }
  return culled;
}

int CullOverBound(Map& map, KeyframeId current, const Sensor& sensor, size_t min_object_views,
                  size_t most) {
  const CullingRules rules = CullingRules::ForSensor(sensor.kind);
  int culled = 0;
  while (culled < kMostAtOnce && map.keyframes().size() > most) {
    double largest = kLeastShareOverBound;
    KeyframeId best;
    for (const auto& [id, keyframe] : map.keyframes()) {
      if (!keyframe.parent.IsValid() ||
          AgeOf(map, id, current, kYoungKeyframes + 1) <= kYoungKeyframes) {
        continue;
      }
      const double share = CountRedundant(map, id, sensor, rules).all.Share();
      if (share > largest && !JoinsItsNeighbours(map, id, rules.min_shared) &&
          !IsNeededByAnObject(map, id, min_object_views, false)) {
        largest = share;
        best = id;
      }
    }
    if (!best.IsValid()) {
      break;
    }
    map.CullKeyframe(best);
    ++culled;
  }
  return culled;
}

void CompactOldKeyframes(Map& map, KeyframeId current, std::vector<KeyframeId>& full) {
  const IdSet<KeyframeId> near = ConnectedTo(map, current);
  std::erase_if(full, [&](KeyframeId id) {
    if (!map.keyframes().Contains(id)) {
      return true;
    }
    if (AgeOf(map, id, current, kYoungKeyframes + 1) <= kYoungKeyframes || near.Contains(id)) {
      return false;
    }
    CompactKeyframe(map, id);
    return true;
  });
}

}  // namespace hullslam
