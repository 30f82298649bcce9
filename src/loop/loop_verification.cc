// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "estimators/similarity.h"
#include "frame/measure_point.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "optim/similarity_optimization.h"
#include "places/similar_places.h"
#include "util/hash.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// Pairs of keypoints of the query and of the candidate.
using KeypointPairs = std::vector<std::pair<uint32_t, uint32_t>>;

// The keypoints of the query at which landmarks of the candidate were found, paired with the
// candidate's keypoints that show these landmarks. Only keypoints of the query that show a landmark
// of their own are included.
KeypointPairs PairsOf(const Keyframe& query, const Keyframe& candidate,
                      std::span<const FoundLandmark> found) {
  KeypointPairs pairs;
  for (const auto& [keypoint, landmark] : found) {
    const auto seen = std::find(candidate.landmarks.begin(), candidate.landmarks.end(), landmark);
    if (query.landmarks[keypoint].IsValid()) {
      pairs.emplace_back(keypoint, static_cast<uint32_t>(seen - candidate.landmarks.begin()));
    }
  }
  return pairs;
}

// One entry per keypoint: whether it shows a landmark.
std::vector<uint8_t> ShowsLandmark(const Keyframe& keyframe) {
  std::vector<uint8_t> shows;
  shows.reserve(keyframe.landmarks.size());
  for (const LandmarkId id : keyframe.landmarks) {
    shows.push_back(id.IsValid() ? 1 : 0);
  }
  return shows;
}

// The matches of the two keyframes: a is the candidate, b is the query.
std::vector<SimilarityMatch> MakeMatches(const Map& map, const Sensor& sensor,
                                         const Keyframe& query, const Keyframe& candidate,
                                         const KeypointPairs& pairs) {
  const auto in_camera = [&](const Keyframe& keyframe, uint32_t keypoint) {
    return keyframe.cam_from_world * map.landmarks().At(keyframe.landmarks[keypoint]).position;
  };
  const auto measured = [&](const Keyframe& keyframe, uint32_t keypoint) {
    return MeasurePoint(sensor, keyframe.frame->features, keypoint, sensor.depth_error);
  };
  std::vector<SimilarityMatch> matches;
  for (const auto& [of_query, of_candidate] : pairs) {
    matches.push_back({.point_in_a = in_camera(candidate, of_candidate),
                       .point_in_b = in_camera(query, of_query),
                       .measured_in_a = measured(candidate, of_candidate),
                       .measured_in_b = measured(query, of_query)});
  }
  return matches;
}

// The pose of the query's camera in the candidate's part of the map. An image does not depend on
// the scale, so the pose is a rigid motion.
Rigid3 PoseAtCandidate(const Sim3& query_from_candidate, const Keyframe& candidate) {
  const Sim3 pose = query_from_candidate * Sim3(candidate.cam_from_world);
  return {pose.rotation, pose.translation / pose.scale};
}

LoopVerdict Refuse(std::string reason) {
  return {.loop = std::nullopt, .refusal = std::move(reason)};
}

}  // namespace

LoopVerdict VerifyLoop(const Map& map, const Sensor& sensor, KeyframeId query, KeyframeId candidate,
                       bool fix_scale, uint64_t seed, const LoopOptions& options) {
  const Keyframe& of_query = map.keyframes().At(query);
  return VerifyLoop(map, sensor, query, candidate,
                    MatchLandmarksByWords(map, *of_query.frame, candidate, ShowsLandmark(of_query)),
                    fix_scale, seed, options);
}

LoopVerdict VerifyLoop(const Map& map, const Sensor& sensor, KeyframeId query, KeyframeId candidate,
                       std::span<const FoundLandmark> matches, bool fix_scale, uint64_t seed,
                       const LoopOptions& options) {
  const Keyframe& of_query = map.keyframes().At(query);
  const Keyframe& of_candidate = map.keyframes().At(candidate);
  const auto matches_of = [&](std::span<const FoundLandmark> found) {
    return MakeMatches(map, sensor, of_query, of_candidate, PairsOf(of_query, of_candidate, found));
  };
  SimilarityOptions search{.fix_scale = fix_scale, .ransac = {}};
  search.ransac.seed = HashSeed(seed, of_query.frame->id.value, "loop");
  search.ransac.min_inliers = static_cast<size_t>(options.min_matches) / 2;
  const Similarity found = EstimateSimilarity(sensor.camera, matches_of(matches), search);
  if (!found.ok()) {
    return Refuse("by descriptors: " + found.failure);
  }
  const std::vector<FoundLandmark> guided =
      FindLandmarks(map, sensor, *of_query.frame, PoseAtCandidate(found.b_from_a, of_candidate),
                    ObservedLandmarks(map, std::span(&candidate, 1)));
  const SimilarityOptimizationResult refined = OptimizeSimilarity(
      sensor.camera, found.b_from_a, matches_of(guided), {.fix_scale = fix_scale, .rounds = {}});
  if (refined.inlier_count < options.min_matches) {
    return Refuse(fmt::format("only {} landmarks of both keyframes agree, expected at least {}",
                              refined.inlier_count, options.min_matches));
  }
  return {.loop = Loop{.query = query,
                       .candidate = candidate,
                       .query_from_candidate = refined.b_from_a,
                       .landmarks = FindLandmarks(map, sensor, *of_query.frame,
                                                  PoseAtCandidate(refined.b_from_a, of_candidate),
                                                  ObservedLandmarks(map, PlaceOf(map, candidate)))},
          .refusal = {}};
}

Travel TravelBetween(const Map& map, KeyframeId first, KeyframeId last) {
  const auto [from, to] = std::minmax(first.value, last.value);
  const IslandId island = IslandOf(map, first);
  const uint32_t made = std::max(map.keyframes().NextId().value, map.culled().NextId().value);
  std::vector<uint32_t> in_island;  // in the order in which they were made
  std::vector<size_t> place(made, SIZE_MAX);
  for (uint32_t i = 0; i < made; ++i) {
    if (IslandOf(map, KeyframeId(i)) == island) {
      place[i] = in_island.size();
      in_island.push_back(i);
    }
  }
  std::vector<Rigid3> world_from_cam;
  std::vector<std::optional<Travel>> known(in_island.size());
  for (const uint32_t id : in_island) {
    world_from_cam.push_back(Inverse(map.CamFromWorld(KeyframeId(id))));
  }
  // Dijkstra's search for the shortest way.
  using Step = std::tuple<double, size_t, double>;  // length, to which place, radians
  std::priority_queue<Step, std::vector<Step>, std::greater<>> next;
  next.emplace(0.0, place.at(from), 0.0);
  while (!next.empty()) {
    const auto [length, at, radians] = next.top();
    next.pop();
    if (known[at]) {
      continue;
    }
    known[at] = Travel{length, radians};
    if (in_island[at] == to) {
      break;
    }
    const auto go = [&, length = length, at = at, radians = radians](size_t there) {
      next.emplace(
          length + (world_from_cam[there].translation - world_from_cam[at].translation).norm(),
          there,
          radians + world_from_cam[there].rotation.angularDistance(world_from_cam[at].rotation));
    };
    if (at > 0) {
      go(at - 1);
    }
    if (at + 1 < in_island.size()) {
      go(at + 1);
    }
    if (const Keyframe* const keyframe = map.keyframes().Find(KeyframeId(in_island[at]))) {
      for (const KeyframeId loop : keyframe->loops) {
        if (place[loop.value] != SIZE_MAX) {
          go(place[loop.value]);
        }
      }
    }
  }
  return known[place.at(to)].value_or(Travel());
}

double MetreOf(const Map& map, KeyframeId id, const Sensor& sensor) {
  const Keyframe& keyframe = map.keyframes().At(id);
  std::vector<double> depths;
  for (const LandmarkId landmark : keyframe.landmarks) {
    if (landmark.IsValid()) {
      depths.push_back((keyframe.cam_from_world * map.landmarks().At(landmark).position).z());
    }
  }
  return sensor.IsMonocular() && !depths.empty() ? Median(std::move(depths)) : 1.0;
}

bool CanBeDrift(const Travel& travel, const Rigid3& tracked_cam_from_world,
                const Rigid3& corrected_cam_from_world, double metre, const LoopOptions& options) {
  const Rigid3 tracked = Inverse(tracked_cam_from_world);
  const Rigid3 corrected = Inverse(corrected_cam_from_world);
  const double metres = travel.length / metre;
  const double moved = (corrected.translation - tracked.translation).norm() / metre;
  const double turned = corrected.rotation.angularDistance(tracked.rotation);
  return moved <= options.drift_base + options.drift_per_metre * metres +
                      options.drift_per_radian * travel.radians &&
         turned <= options.turn_base + options.turn_per_metre * metres +
                       options.turn_per_radian * travel.radians;
}

}  // namespace hullslam
