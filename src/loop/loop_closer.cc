// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_closer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "loop/drift_budget.h"
#include "loop/loop_correction.h"
#include "loop/loop_verification.h"
#include "map/correction.h"

namespace hullslam {
namespace {

constexpr uint32_t kKeyframesAfterLoop = 10;  // in which no other loop is sought

// The query's pose if the loop is right, at the scale of the query.
Rigid3 PoseByLoop(const Map& map, const Loop& loop) {
  const Sim3 pose =
      loop.query_from_candidate * Sim3(map.keyframes().At(loop.candidate).cam_from_world);
  return {pose.rotation, pose.translation / pose.scale};
}

double CameraDistance(const Rigid3& a, const Rigid3& b) {
  return (Inverse(a).translation - Inverse(b).translation).norm();
}

}  // namespace

LoopCloser::LoopCloser(const Sensor& sensor, const LoopOptions& options,
                       const ObjectOptions& objects, uint64_t seed)
    : sensor_(sensor), options_(options), object_options_(objects), seed_(seed) {}

std::optional<MapCorrection> LoopCloser::Process(LoopQuery query) {
  const uint32_t keyframe = query.keyframe.value;
  const bool is_soon = last_loop_.IsValid() && keyframe < last_loop_.value + kKeyframesAfterLoop;
  if (!options_.enabled || query.map.vocabulary() == nullptr || is_soon) {
    return std::nullopt;
  }
  for (const LoopCandidate& candidate : FindLoopCandidates(query.map, query.keyframe)) {
    std::string refusal;
    if (std::optional<MapCorrection> correction = Close(query, candidate, refusal)) {
      spdlog::debug("loop: keyframe {} is at the place of {}", keyframe, candidate.keyframe.value);
      last_loop_ = query.keyframe;
      return correction;
    }
    spdlog::debug("loop: keyframe {} is not at the place of {}: {}", keyframe,
                  candidate.keyframe.value, refusal);
  }
  return std::nullopt;
}

std::optional<MapCorrection> LoopCloser::Close(LoopQuery& query, const LoopCandidate& candidate,
                                               std::string& refusal) const {
  const Map& map = query.map;
  const LoopVerdict verdict = VerifyLoop(map, sensor_, query.keyframe, candidate.keyframe,
                                         !sensor_.IsMonocular(), seed_, options_);
  if (!verdict.loop) {
    refusal = verdict.refusal;
    return std::nullopt;
  }
  const Loop& loop = *verdict.loop;
  const Travel travel = TravelBetween(map, candidate.keyframe, query.keyframe);
  const Rigid3& tracked = map.keyframes().At(query.keyframe).cam_from_world;
  const Rigid3 by_loop = PoseByLoop(map, loop);
  if (!CanBeDrift(travel, tracked, by_loop, options_)) {
    refusal = fmt::format("it would move the camera by {:.2f} m after {:.1f} m",
                          CameraDistance(by_loop, tracked), travel.metres);
    return std::nullopt;
  }
  MapCorrection correction = SpreadLoopError(map, loop, !sensor_.IsMonocular());
  if (correction.poses.empty()) {
    refusal = "the pose graph could not be solved";
    return std::nullopt;
  }
  Map corrected = query.map.Snapshot();
  ApplyCorrection(corrected, correction, sensor_.levels);
  const ObjectVotes votes =
      CountObjectVotes(corrected, sensor_, query.keyframe, candidate.keyframe, object_options_);
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
  spdlog::debug("loop: {} landmarks, {} neighbours and {} objects agree, {} objects do not",
                loop.landmarks.size(), candidate.supporters, votes.agree, votes.disagree);
  AddMerges(corrected, sensor_, loop, object_options_.fusion, correction);
  return correction;
}

// Half as many landmarks are enough if the objects at both ends agree, and twice as many are needed
// if the query's neighbours do not look like the candidate's place.
size_t LoopCloser::LandmarksNeeded(const LoopCandidate& candidate, const ObjectVotes& votes) const {
  const auto needed = static_cast<size_t>(options_.min_landmarks);
  const bool is_supported = candidate.supporters >= options_.min_supporters;
  return (votes.IsFor() ? needed / 2 : needed) * (is_supported ? 1 : 2);
}

}  // namespace hullslam
