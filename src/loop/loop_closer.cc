// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_closer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "loop/island_join.h"
#include "loop/loop_candidates.h"
#include "loop/loop_correction.h"
#include "loop/loop_verification.h"
#include "map/correction.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "places/landmark_search.h"
#include "places/similar_places.h"

namespace hullslam {
namespace {

constexpr uint32_t kKeyframesAfterLoop = 10;  // without a search for another loop

// The pose that the loop gives the query, at the scale of the query.
Rigid3 PoseByLoop(const Map& map, const Loop& loop) {
  const Sim3 pose =
      loop.query_from_candidate * Sim3(map.keyframes().At(loop.candidate).cam_from_world);
  return {pose.rotation, pose.translation / pose.scale};
}

// Whether the keyframes belong to different islands.
bool AreApart(const Map& map, KeyframeId a, KeyframeId b) {
  return IslandOf(map, a) != IslandOf(map, b);
}

// Whether the loop edge is in the map. Those of a culled keyframe were handed to others.
bool AreJoined(const Map& map, const MapCorrection::LoopEdge& edge) {
  const Keyframe* const a = map.keyframes().Find(edge.a);
  return a == nullptr || !map.keyframes().Contains(edge.b) ||
         std::binary_search(a->loops.begin(), a->loops.end(), edge.b);
}

double CameraDistance(const Rigid3& a, const Rigid3& b) {
  return (Inverse(a).translation - Inverse(b).translation).norm();
}

}  // namespace

LoopCloser::LoopCloser(const Sensor& sensor, const LoopOptions& options,
                       const ObjectOptions& objects, uint64_t seed)
    : sensor_(sensor), options_(options), object_options_(objects), seed_(seed) {}

std::optional<MapCorrection> LoopCloser::Process(LoopQuery query) {
  CheckSentLoop(query.map);
  const uint32_t keyframe = query.keyframe.value;
  const bool is_soon = last_loop_.IsValid() && keyframe < last_loop_.value + kKeyframesAfterLoop;
  // Islands are joined as soon as possible.
  const bool may_join = Islands(query.map).size() > 1;
  if (!options_.enabled || query.map.vocabulary() == nullptr || (is_soon && !may_join)) {
    return std::nullopt;
  }
  for (const LoopCandidate& candidate : FindLoopCandidates(query.map, query.keyframe)) {
    if (is_soon && !AreApart(query.map, query.keyframe, candidate.keyframe)) {
      continue;
    }
    std::string refusal;
    if (std::optional<MapCorrection> correction = Close(query, candidate, refusal)) {
      spdlog::debug("loop: keyframe {} is at the place of {}", keyframe, candidate.keyframe.value);
      Remember(query.keyframe, *correction);
      return correction;
    }
    spdlog::debug("loop: keyframe {} is not at the place of {}: {}", keyframe,
                  candidate.keyframe.value, refusal);
  }
  return is_soon ? std::nullopt : JoinReturn(query);
}

void LoopCloser::Remember(KeyframeId query, const MapCorrection& correction) {
  sent_ = SentLoop{.edge = *correction.loop,
                   .snapshot_corrections = correction.snapshot_corrections,
                   .former_loop = std::exchange(last_loop_, query)};
}

// If the map was corrected, but the last loop is not in it, the mapper has dropped that loop.
void LoopCloser::CheckSentLoop(const Map& map) {
  if (!sent_ || map.correction_count() == sent_->snapshot_corrections) {
    return;
  }
  if (!AreJoined(map, sent_->edge)) {
    spdlog::debug("loop: that of keyframe {} was dropped and is sought again", last_loop_.value);
    last_loop_ = sent_->former_loop;
  }
  sent_.reset();
}

std::optional<MapCorrection> LoopCloser::JoinReturn(const LoopQuery& query) {
  const std::optional<Return> found =
      FindReturn(query.map, query.keyframe, static_cast<size_t>(options_.min_landmarks));
  if (!found) {
    return std::nullopt;
  }
  MapCorrection correction = JoinVisits(query.map, sensor_, *found, object_options_.fusion);
  spdlog::debug("loop: tracking has led keyframe {} to the place of {}: {} landmarks are merged",
                query.keyframe.value, found->candidate.value, correction.landmarks.size());
  Remember(query.keyframe, correction);
  return correction;
}

std::optional<MapCorrection> LoopCloser::Close(LoopQuery& query, const LoopCandidate& candidate,
                                               std::string& refusal) const {
  const Map& map = query.map;
  const bool fix_scale = !sensor_.IsMonocular();
  const LoopVerdict verdict =
      VerifyLoop(map, sensor_, query.keyframe, candidate.keyframe, fix_scale, seed_, options_);
  if (!verdict.loop) {
    refusal = verdict.refusal;
    return std::nullopt;
  }
  const Loop& loop = *verdict.loop;
  const bool is_apart = AreApart(map, query.keyframe, candidate.keyframe);
  const bool is_join = is_apart || !AreConnected(map, query.keyframe, candidate.keyframe);
  if (!is_join) {
    refusal = FindTooMuchDrift(map, loop);
    if (!refusal.empty()) {
      return std::nullopt;
    }
  }
  MapCorrection correction =
      is_apart ? MoveIsland(map, loop) : SpreadLoopError(map, loop, fix_scale);
  if (correction.poses.empty()) {
    refusal = "the pose graph could not be solved";
    return std::nullopt;
  }
  Map corrected = query.map.Snapshot();
  ApplyCorrection(corrected, correction, sensor_.levels);
  const ObjectVotes votes = options_.object_votes
                                ? CountObjectVotes(corrected, sensor_, query.keyframe,
                                                   candidate.keyframe, object_options_)
                                : ObjectVotes();
  if (votes.IsAgainst()) {
    refusal = fmt::format("{} objects agree, {} do not", votes.agree, votes.disagree);
    return std::nullopt;
  }
  const size_t needed = LandmarksNeeded(candidate, votes);
  if (loop.landmarks.size() < needed) {
    refusal = fmt::format("it shows {} of the landmarks there, expected at least {}",
                          loop.landmarks.size(), needed);
    return std::nullopt;
  }
  if (is_join && !IsConfirmedByNeighbour(corrected, sensor_, loop,
                                         static_cast<size_t>(options_.min_landmarks))) {
    refusal = "no neighbour shows the landmarks there";
    return std::nullopt;
  }
  spdlog::debug("loop: {} landmarks, {} neighbours and {} objects agree, {} objects do not",
                loop.landmarks.size(), candidate.supporters, votes.agree, votes.disagree);
  AddMerges(corrected, sensor_, loop, object_options_.fusion, correction);
  return correction;
}

// The reason why the loop exceeds the drift budget; empty if it does not.
std::string LoopCloser::FindTooMuchDrift(const Map& map, const Loop& loop) const {
  const Travel travel = TravelBetween(map, loop.candidate, loop.query);
  const Rigid3& tracked = map.keyframes().At(loop.query).cam_from_world;
  const Rigid3 by_loop = PoseByLoop(map, loop);
  const double metre = MetreOf(map, loop.query, sensor_);
  return CanBeDrift(travel, tracked, by_loop, metre, options_)
             ? std::string()
             : fmt::format("it would move the camera by {:.2f} m after {:.1f} m",
                           CameraDistance(by_loop, tracked) / metre, travel.length / metre);
}

// Half as many landmarks are enough if the objects at both ends agree, and twice as many are needed
// if the query's neighbours do not look like the candidate's place.
size_t LoopCloser::LandmarksNeeded(const LoopCandidate& candidate, const ObjectVotes& votes) const {
  const auto needed = static_cast<size_t>(options_.min_landmarks);
  const bool is_supported = candidate.supporters >= options_.min_supporters;
  return (votes.IsFor() ? needed / 2 : needed) * (is_supported ? 1 : 2);
}

}  // namespace hullslam
