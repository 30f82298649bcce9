// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/island_join.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "loop/loop_correction.h"
#include "loop/loop_verification.h"
#include "loop/object_votes.h"
#include "map/correction.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/keyframe_order.h"
#include "places/depth_agreement.h"
#include "places/landmark_search.h"
#include "places/similar_places.h"

namespace hullslam {
namespace {

// The largest share of depth samples of a join that the other end sees past.
constexpr double kMostPastJoin = 0.1;

bool DepthsAgree(const Map& corrected, const Sensor& sensor, const Loop& loop) {
  DepthAgreement agreement;
  const Keyframe& query = corrected.keyframes().At(loop.query);
  for (const KeyframeId id : PlaceOf(corrected, loop.candidate)) {
    const Keyframe& other = corrected.keyframes().At(id);
    agreement.Add(CompareDepths(sensor, *query.frame, *other.frame,
                                other.cam_from_world * Inverse(query.cam_from_world)));
  }
  return agreement.past <= kMostPastJoin * agreement.compared();
}

// The number of landmarks that the query must find at the candidate. Frames so near in time may be
// expected to show the same place; others may only look alike, and errors are three times as large
// where images are far apart, so three times as many are needed. They always are without depth,
// where few landmarks may agree at a wrong scale.
size_t LandmarksNeededForJoin(const Map& corrected, const Sensor& sensor, const Loop& loop,
                              size_t least) {
  constexpr uint32_t kNearFrames = 5;
  const auto [first, last] = std::minmax(
      {FrameIdOf(corrected, loop.query).value, FrameIdOf(corrected, loop.candidate).value});
  if (last - first > kNearFrames || sensor.IsMonocular()) {
    return 3 * least;
  }
  return IsConfirmedByNeighbour(corrected, sensor, loop, least) ? least : 2 * least;
}

// The reason why the loop does not join its islands; empty if it does.
std::string WhyNotJoined(const Map& corrected, const Sensor& sensor, const Loop& loop,
                         const LoopOptions& options, const ObjectOptions& objects) {
  const size_t needed =
      LandmarksNeededForJoin(corrected, sensor, loop, static_cast<size_t>(options.min_landmarks));
  if (loop.landmarks.size() < needed) {
    return fmt::format("it shows {} of the landmarks there, expected at least {}",
                       loop.landmarks.size(), needed);
  }
  if (options.object_votes &&
      CountObjectVotes(corrected, sensor, loop.query, loop.candidate, objects).IsAgainst()) {
    return "objects do not agree";
  }
  return DepthsAgree(corrected, sensor, loop) ? "" : "depths do not agree";
}

}  // namespace

bool IsConfirmedByNeighbour(const Map& corrected, const Sensor& sensor, const Loop& loop,
                            size_t min_landmarks) {
  const std::vector<LandmarkId> landmarks =
      ObservedLandmarks(corrected, PlaceOf(corrected, loop.candidate));
  const std::vector<KeyframeId> place = PlaceOf(corrected, loop.query);
  return std::any_of(place.begin(), place.end(), [&](KeyframeId id) {
    const Keyframe& neighbour = corrected.keyframes().At(id);
    return id != loop.query &&
           FindLandmarks(corrected, sensor, *neighbour.frame, neighbour.cam_from_world, landmarks)
                   .size() >= min_landmarks;
  });
}

std::optional<MapCorrection> FindJoin(Map& map, KeyframeId query, const Sensor& sensor,
                                      const LoopOptions& options, const ObjectOptions& objects,
                                      uint64_t seed) {
  const std::shared_ptr<const Frame> frame = map.keyframes().At(query).frame;
  for (const KeyframeId candidate : KeyframesForWideMatches(map, *frame, IslandOf(map, query))) {
    const LoopVerdict verdict =
        VerifyLoop(map, sensor, query, candidate, MatchLandmarksOf(map, *frame, candidate),
                   !sensor.IsMonocular(), seed, options);
    if (!verdict.loop) {
      continue;
    }
    MapCorrection correction = MoveIsland(map, *verdict.loop);
    Map corrected = map.Snapshot();
    ApplyCorrection(corrected, correction, sensor.levels);
    const std::string refusal = WhyNotJoined(corrected, sensor, *verdict.loop, options, objects);
    spdlog::debug(
        "join: keyframe {} is {}at the place of {} in another part: {}", query.value,
        refusal.empty() ? "" : "not ", candidate.value,
        refusal.empty() ? fmt::format("{} landmarks", verdict.loop->landmarks.size()) : refusal);
    if (refusal.empty()) {
      AddMerges(corrected, sensor, *verdict.loop, objects.fusion, correction);
      return correction;
    }
  }
  return std::nullopt;
}

}  // namespace hullslam
