// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_closer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "loop/drift_budget.h"
#include "loop/loop_candidates.h"
#include "loop/loop_correction.h"
#include "loop/loop_verification.h"
#include "loop/object_votes.h"
#include "map/correction.h"

namespace hullslam {
namespace {

constexpr bool kFixScale = true;              // RGB-D
constexpr uint32_t kKeyframesAfterLoop = 10;  // in which no other loop is sought

// The query's pose if the loop is right, at the scale of the query.
Rigid3 PoseByLoop(const Map& map, const Loop& loop) {
  const Sim3 pose =
      loop.query_from_candidate * Sim3(map.keyframes().At(loop.candidate).cam_from_world);
  return {pose.rotation, pose.translation / pose.scale};
}

}  // namespace

LoopCloser::LoopCloser(const Sensor& sensor, const LoopOptions& options,
                       const ObjectOptions& objects, uint64_t seed)
    : sensor_(sensor), options_(options), object_options_(objects), seed_(seed) {}

std::optional<MapCorrection> LoopCloser::Process(LoopQuery query) {
  const Map& map = query.map;
  const KeyframeId keyframe = query.keyframe;
  const bool is_soon =
      last_loop_.IsValid() && keyframe.value < last_loop_.value + kKeyframesAfterLoop;
  if (!options_.enabled || map.vocabulary() == nullptr || is_soon) {
    return std::nullopt;
  }
  for (const KeyframeId candidate : FindLoopCandidates(map, keyframe, options_.min_supporters)) {
    std::string refusal;
    if (std::optional<MapCorrection> correction = Close(query, candidate, refusal)) {
      spdlog::debug("loop: keyframe {} is at the place of {}", keyframe.value, candidate.value);
      last_loop_ = keyframe;
      return correction;
    }
    spdlog::debug("loop: keyframe {} is not at the place of {}: {}", keyframe.value,
                  candidate.value, refusal);
  }
  return std::nullopt;
}

std::optional<MapCorrection> LoopCloser::Close(LoopQuery& query, KeyframeId candidate,
                                               std::string& refusal) const {
  const Map& map = query.map;
  const KeyframeId keyframe = query.keyframe;
  LoopVerdict verdict = VerifyLoop(map, sensor_, keyframe, candidate, kFixScale, seed_, options_);
  if (!verdict.loop) {
    refusal = std::move(verdict.refusal);
    return std::nullopt;
  }
  const Loop& loop = *verdict.loop;
  const Travel travel = TravelBetween(map, candidate, keyframe);
  const Rigid3& tracked = map.keyframes().At(keyframe).cam_from_world;
  if (!CanBeDrift(travel, tracked, PoseByLoop(map, loop), options_)) {
    refusal = fmt::format(
        "it would move the camera by {:.2f} m after {:.1f} m",
        (Inverse(PoseByLoop(map, loop)).translation - Inverse(tracked).translation).norm(),
        travel.metres);
    return std::nullopt;
  }
  MapCorrection correction = SpreadLoopError(map, loop, kFixScale);
  if (correction.poses.empty()) {
    refusal = "the pose graph could not be solved";
    return std::nullopt;
  }
  Map corrected = query.map.Snapshot();
  ApplyCorrection(corrected, correction, sensor_.levels);
  const ObjectVotes votes =
      CountObjectVotes(corrected, sensor_, keyframe, candidate, object_options_);
  const int least = votes.IsFor() ? options_.min_landmarks / 2 : options_.min_landmarks;
  if (votes.IsAgainst()) {
    refusal = fmt::format("{} objects agree, {} do not", votes.agree, votes.disagree);
    return std::nullopt;
  }
  if (loop.landmarks.size() < static_cast<size_t>(least)) {
    refusal = fmt::format("it shows {} of the landmarks around it, expected at least {}",
                          loop.landmarks.size(), least);
    return std::nullopt;
  }
  AddMerges(corrected, sensor_, loop, object_options_.fusion, correction);
  return correction;
}

}  // namespace hullslam
