// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "estimators/similarity.h"
#include "frame/point_measurement.h"
#include "map/covisibility.h"
#include "map/landmark_projection.h"
#include "matching/by_projection.h"
#include "matching/by_words.h"
#include "optim/similarity_optimization.h"
#include "util/random_seed.h"

namespace hullslam {
namespace {

constexpr size_t kNeighbours = 10;  // of the candidate, whose landmarks are searched
constexpr float kRadius = 8.0f;     // px at level 0, around where the similarity expects a landmark
constexpr int kMaxDistance = 100;   // Hamming, where the position is known
// The level of the vocabulary at which keypoints are compared. Below it are about a hundred words
// of a vocabulary with ten branches: fewer comparisons lose too many matches.
constexpr int kNodeLevel = 2;

// Pairs of keypoints of two keyframes.
using KeypointPairs = std::vector<std::pair<uint32_t, uint32_t>>;

// The nodes of the keypoints that show a landmark; invalid for the others.
std::vector<VocabularyNodeId> LandmarkNodes(const Keyframe& keyframe,
                                            const Vocabulary& vocabulary) {
  std::vector<VocabularyNodeId> nodes = vocabulary.NodesOf(keyframe.frame->words, kNodeLevel);
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (!keyframe.landmarks[i].IsValid()) {
      nodes[i] = VocabularyNodeId();
    }
  }
  return nodes;
}

KeypointPairs MatchLandmarks(const Keyframe& query, const Keyframe& candidate,
                             const Vocabulary& vocabulary) {
  KeypointPairs pairs;
  for (const Match& match : MatchByWords(query.frame->features, LandmarkNodes(query, vocabulary),
                                         candidate.frame->features,
                                         LandmarkNodes(candidate, vocabulary), {})) {
    pairs.emplace_back(match.query, match.keypoint);
  }
  return pairs;
}

// The matches from a = candidate to b = query.
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

// The pose of the query's camera in the candidate's part of the map. A camera does not see scale,
// so this is a rigid motion.
Rigid3 PoseAtCandidate(const Sim3& query_from_candidate, const Keyframe& candidate) {
  const Sim3 pose = query_from_candidate * Sim3(candidate.cam_from_world);
  return {pose.rotation, pose.translation / pose.scale};
}

std::vector<LandmarkId> LandmarksOf(const Keyframe& keyframe) {
  std::vector<LandmarkId> landmarks;
  std::copy_if(keyframe.landmarks.begin(), keyframe.landmarks.end(), std::back_inserter(landmarks),
               [](LandmarkId id) { return id.IsValid(); });
  return landmarks;
}

// Pairs with the landmarks of the candidate that the similarity leads to. Only keypoints of the
// query that show landmarks of their own are of use.
KeypointPairs GuidedPairs(const Map& map, const Sensor& sensor, const Sim3& query_from_candidate,
                          KeyframeId query, KeyframeId candidate) {
  const Keyframe& of_query = map.keyframes().At(query);
  const Keyframe& of_candidate = map.keyframes().At(candidate);
  KeypointPairs pairs;
  for (const Loop::Sighting& sighting :
       FindLandmarks(map, sensor, query, PoseAtCandidate(query_from_candidate, of_candidate),
                     LandmarksOf(of_candidate))) {
    if (of_query.landmarks[sighting.keypoint].IsValid()) {
      const auto place = std::find(of_candidate.landmarks.begin(), of_candidate.landmarks.end(),
                                   sighting.landmark);
      pairs.emplace_back(sighting.keypoint,
                         static_cast<uint32_t>(place - of_candidate.landmarks.begin()));
    }
  }
  return pairs;
}

LoopVerdict Refuse(std::string reason) {
  return {.loop = std::nullopt, .refusal = std::move(reason)};
}

}  // namespace

std::vector<Loop::Sighting> FindLandmarks(const Map& map, const Sensor& sensor, KeyframeId keyframe,
                                          const Rigid3& cam_from_world,
                                          const std::vector<LandmarkId>& landmarks) {
  const FrameFeatures& features = map.keyframes().At(keyframe).frame->features;
  std::vector<Projection> projections;
  std::vector<LandmarkId> ids;
  std::vector<Eigen::Vector3d> points_in_cam;
  for (const LandmarkId id : landmarks) {
    const Landmark& landmark = map.landmarks().At(id);
    const auto view = ViewLandmark(sensor, cam_from_world, landmark);
    if (!view) {
      continue;
    }
    Projection& projection = projections.emplace_back();
    projection.pixel = view->pixel.cast<float>();
    projection.radius = kRadius * sensor.levels.scale[static_cast<size_t>(view->level)];
    projection.min_level = view->level - 1;
    projection.max_level = view->level;
    projection.descriptor = landmark.descriptor;
    ids.push_back(id);
    points_in_cam.push_back(view->point_in_cam);
  }
  const auto reprojects = [&](uint32_t query, uint32_t keypoint) {
    return IsInlier(sensor.camera, MeasurePoint(sensor, features, keypoint, sensor.depth_error),
                    points_in_cam[query]);
  };
  std::vector<Loop::Sighting> sightings;
  for (const Match& match :
       MatchByProjection(features, projections, {},
                         {.max_distance = kMaxDistance, .may_match = reprojects})) {
    sightings.push_back({match.keypoint, ids[match.query]});
  }
  return sightings;
}

LoopVerdict VerifyLoop(const Map& map, const Sensor& sensor, const Vocabulary& vocabulary,
                       KeyframeId query, KeyframeId candidate, bool fix_scale, uint64_t seed,
                       const LoopOptions& options) {
  const Keyframe& of_query = map.keyframes().At(query);
  const Keyframe& of_candidate = map.keyframes().At(candidate);
  const auto least = static_cast<size_t>(options.min_matches);
  const KeypointPairs by_words = MatchLandmarks(of_query, of_candidate, vocabulary);
  SimilarityOptions search{.fix_scale = fix_scale, .ransac = {}};
  search.ransac.seed = HashSeed(seed, of_query.frame->id.value, "loop");
  search.ransac.min_inliers = least / 2;
  const Similarity found =
      EstimateSimilarity(sensor.camera, MakeMatches(map, sensor, of_query, of_candidate, by_words),
                         search);
  if (!found.ok()) {
    return Refuse("by words: " + found.failure);
  }
  const KeypointPairs guided = GuidedPairs(map, sensor, found.b_from_a, query, candidate);
  const SimilarityOptimizationResult refined = OptimizeSimilarity(
      sensor.camera, found.b_from_a, MakeMatches(map, sensor, of_query, of_candidate, guided),
      {.fix_scale = fix_scale, .rounds = {}});
  if (refined.inlier_count < options.min_matches) {
    return Refuse(fmt::format("only {} landmarks of both keyframes agree, expected at least {}",
                              refined.inlier_count, options.min_matches));
  }
  std::vector<KeyframeId> around = BestCovisible(of_candidate, kNeighbours);
  around.push_back(candidate);
  Loop loop{.query = query,
            .candidate = candidate,
            .query_from_candidate = refined.b_from_a,
            .sightings = FindLandmarks(map, sensor, query,
                                       PoseAtCandidate(refined.b_from_a, of_candidate),
                                       ObservedLandmarks(map, around))};
  if (loop.sightings.size() < static_cast<size_t>(options.min_landmarks)) {
    return Refuse(
        fmt::format("the query sees only {} landmarks around the candidate, expected at least {}",
                    loop.sightings.size(), options.min_landmarks));
  }
  return {.loop = std::move(loop), .refusal = {}};
}

}  // namespace hullslam
