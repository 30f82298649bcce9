// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/summarize_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "eval/object_metrics.h"
#include "eval/reprojection_error.h"
#include "hullslam/eval/ate.h"
#include "hullslam/eval/rpe.h"
#include "hullslam/settings/settings.h"
#include "map/islands.h"
#include "util/text.h"

namespace hullslam {
namespace {

Trajectory Scaled(Trajectory trajectory, double scale) {
  for (StampedPose& pose : trajectory) {
    pose.world_from_cam.translation *= scale;
  }
  return trajectory;
}

// Depth in a wrong unit, or a wrong baseline, gives a map of the wrong size, which nothing but the
// ground truth reveals.
void CheckScale(const Trajectory& groundtruth, const Trajectory& trajectory, double rmse,
                SensorKind sensor, std::vector<std::string>& warnings) {
  constexpr double kMostDifference = 0.1;  // the depth of real cameras is wrong by up to 4 %
  constexpr double kMuchBetter = 0.5;
  const AteResult scaled =
      EvaluateAte(groundtruth, trajectory, {.alignment = AlignmentKind::kSim3});
  const double scale = scaled.reference_from_estimate.scale;
  if (scaled.ok() && std::abs(scale - 1.0) > kMostDifference &&
      scaled.errors.rmse < kMuchBetter * rmse) {
    warnings.push_back(fmt::format(
        "the trajectory is {:.2g} times as large as the ground truth; is {} right?", 1.0 / scale,
        sensor == SensorKind::kRgbd ? "DepthMapFactor" : "the baseline of the cameras"));
  }
}

void Evaluate(const Trajectory& groundtruth, const Trajectory& trajectory, SensorKind sensor,
              TrajectorySummary& summary, std::vector<std::string>& warnings) {
  const auto warn = [&](const std::string& text) {
    if (!text.empty()) {
      warnings.push_back(text);
    }
  };
  const AteResult ate = EvaluateAte(groundtruth, trajectory, {.alignment = AlignmentOf(sensor)});
  if (!ate.ok()) {
    warn("the trajectory error cannot be computed: " + ate.failure);
    return;
  }
  warn(DescribeMissingPairs(ate));
  summary.ate_rmse_m = ate.errors.rmse;
  summary.scale = ate.reference_from_estimate.scale;
  summary.pairs = ate.pairs;
  if (AlignmentOf(sensor) == AlignmentKind::kSe3) {
    CheckScale(groundtruth, trajectory, ate.errors.rmse, sensor, warnings);
  }
  const Trajectory scaled = Scaled(trajectory, ate.reference_from_estimate.scale);
  const RpeResult rpe = EvaluateRpe(groundtruth, scaled);
  warn(DescribeSwappedRotations(groundtruth, scaled, rpe));
  if (rpe.ok()) {
    summary.rpe_rmse_m = rpe.translation.rmse;
    summary.rpe_rmse_deg = rpe.rotation.rmse;
  }
}

size_t CountLost(const System& system) {
  const std::span<const TrackedFrame> frames = system.frames();
  return static_cast<size_t>(std::count_if(
      frames.begin(), frames.end(),
      [](const TrackedFrame& frame) { return frame.state != TrackingState::kTracked; }));
}

// The error after an alignment of its own; unknown without ground truth.
std::optional<double> ErrorOf(const std::optional<Trajectory>& groundtruth,
                              const Trajectory& trajectory, SensorKind sensor) {
  if (!groundtruth || trajectory.empty()) {
    return std::nullopt;
  }
  const AteResult ate = EvaluateAte(*groundtruth, trajectory, {.alignment = AlignmentOf(sensor)});
  return ate.ok() ? std::optional(ate.errors.rmse) : std::nullopt;
}

IslandSummary SummarizeIsland(IslandId id, const Map& map, const Trajectory& trajectory) {
  IslandSummary summary{.number = id.value + size_t{1},
                        .keyframes = map.keyframes().size(),
                        .landmarks = map.landmarks().size(),
                        .frames = trajectory.size()};
  if (!trajectory.empty()) {
    summary.first_timestamp = trajectory.front().timestamp;
    summary.last_timestamp = trajectory.back().timestamp;
  }
  return summary;
}

IslandsSummary SummarizeIslands(const System& system, const Trajectory& trajectory,
                                const std::optional<Trajectory>& groundtruth, SensorKind sensor) {
  const std::shared_ptr<const Map> map = system.map();
  if (map == nullptr || map->keyframes().empty()) {
    return {};
  }
  IslandsSummary summary{.begun = map->islands_begun(), .joined = map->islands_joined()};
  summary.at_end.push_back(SummarizeIsland(MainIsland(*map), *map, trajectory));
  summary.at_end.back().is_main = true;
  summary.at_end.back().ate_rmse_m = ErrorOf(groundtruth, trajectory, sensor);
  for (const LeftIsland& island : system.left_islands()) {
    summary.at_end.push_back(SummarizeIsland(island.id, *island.map, island.trajectory));
    summary.at_end.back().ate_rmse_m = ErrorOf(groundtruth, island.trajectory, sensor);
  }
  return summary;
}

// Each loop is stored in both keyframes, so it is counted twice.
size_t CountLoops(const Map& map) {
  size_t ends = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    ends += keyframe.loops.size();
  }
  return ends / 2;
}

// A text such as "40 x too little parallax, 3 x too few matches", the most frequent reason first,
// with advice for the user.
std::string DescribeFailures(const InitialisationSummary& initialisation) {
  std::vector<std::pair<size_t, std::string>> reasons;
  for (const auto& [reason, count] : initialisation.failures) {
    reasons.emplace_back(count, fmt::format("{} x {}", count, reason));
  }
  std::sort(reasons.rbegin(), reasons.rend());
  std::string text;
  for (const auto& [count, reason] : reasons) {
    text += (text.empty() ? "" : ", ") + reason;
  }
  const bool lacks_parallax =
      !reasons.empty() &&
      reasons.front().second.ends_with(ToString(InitialisationFailure::kTooLittleParallax));
  return text + (lacks_parallax
                     ? "; the camera must move sideways, or, if it can only go forward, as in a "
                       "car, have more features: --set ORBextractor.nFeatures=2000"
                     : "");
}

// Says why a run of `given` frames that came to its end counts as failed. Empty if it does not.
std::string DescribeLoss(const System& system, size_t given, const RunSummary& summary) {
  const RunOptions& options = system.options().run;
  const std::span<const TrackedFrame> frames = system.frames();
  const TrajectorySummary& trajectory = summary.trajectory;
  if (summary.provenance.loaded_map && trajectory.tracked == 0) {
    return fmt::format("{}: no frame was found in this map, so none of {} frames has a pose",
                       *summary.provenance.loaded_map, given);
  }
  if (summary.initialisation && !summary.initialisation->seconds) {
    return fmt::format("no map could be made from {}: {}",
                       Counted(summary.trajectory.frames, "frame"),
                       DescribeFailures(*summary.initialisation));
  }
  const std::string found = fmt::format("{} of {} frames have a pose", trajectory.tracked, given);
  const auto all = static_cast<double>(given);
  if (all - static_cast<double>(trajectory.tracked) > options.max_lost_share * all) {
    return fmt::format("too many frames were lost: {} (run.max_lost_share {:g})", found,
                       options.max_lost_share);
  }
  const auto last_tracked = std::find_if(
      frames.rbegin(), frames.rend(),
      [](const TrackedFrame& frame) { return frame.state == TrackingState::kTracked; });
  if (last_tracked != frames.rend() &&
      frames.back().timestamp - last_tracked->timestamp > options.max_lost_at_end) {
    return fmt::format(
        "tracking was lost and did not recover before the end: {} (run.max_lost_at_end {:g} s)",
        found, options.max_lost_at_end);
  }
  return {};
}

std::map<PriorUse, size_t> CountPriors(std::span<const TrackedFrame> frames) {
  std::map<PriorUse, size_t> uses;
  for (const TrackedFrame& frame : frames) {
    ++uses[frame.prior];
  }
  return uses;
}

}  // namespace

RunSummary SummarizeRun(const RunResult& result, const System& system,
                        const std::optional<Trajectory>& groundtruth,
                        std::vector<std::string>& warnings) {
  const SystemOptions& options = system.options();
  RunSummary summary;
  summary.trajectory.alignment = ToString(AlignmentOf(options.sensor));
  summary.trajectory.frames = result.given;
  summary.trajectory.skipped = result.skipped;
  summary.trajectory.lost = CountLost(system);
  summary.trajectory.tracked = system.frames().size() - summary.trajectory.lost;
  summary.trajectory.losses = FindLostStretches(system.frames(), result.notes.all());
  summary.trajectory.unsure = FindUnsureStretches(system.frames(), result.notes.all());

  summary.timing.stages_ms = SummarizeStages(system.times());
  summary.timing.track_ms = summary.timing.stages_ms["track"];
  summary.timing.stages_ms.erase("track");
  summary.timing.total_s = result.seconds;
  summary.timing.frames_per_second =
      static_cast<double>(result.given) / std::max(result.seconds, 1e-9);
  summary.peak_memory_mb = PeakMemoryMb();
  if (const auto map = system.map()) {
    summary.map.keyframes = map->keyframes().size();
    summary.map.landmarks = map->landmarks().size();
    summary.map.contradicted_landmarks = system.contradicted_landmarks();
    summary.map.sessions = map->sessions().size();
    summary.map.loops = CountLoops(*map);
    summary.map.reprojection_px = MedianReprojectionError(*map, options.camera);
    if (options.sensor == SensorKind::kMonocular) {
      const size_t sized = system.sized_objects();
      if (sized > 0 || !options.objects.sizes.empty()) {
        summary.map.known_sizes = sized;
      }
    }
  }
  if (options.sensor == SensorKind::kMonocular) {
    summary.initialisation = result.initialisation;
  }
  std::map<PriorUse, size_t> priors = CountPriors(system.frames());
  if (priors[PriorUse::kDropped] > priors[PriorUse::kFused]) {
    warnings.push_back(fmt::format(
        "the odometry is contradicted by {} and fused with {}, expected the way of the camera, not "
        "of the body that carries it, in m, and its errors in odometry.sigma_way and sigma_turn",
        Counted(priors[PriorUse::kDropped], "frame"), Counted(priors[PriorUse::kFused], "frame")));
  }
  const Trajectory trajectory = system.trajectory();
  if (groundtruth && !trajectory.empty()) {
    Evaluate(*groundtruth, trajectory, options.sensor, summary.trajectory, warnings);
  }
  summary.islands = SummarizeIslands(system, trajectory, groundtruth, options.sensor);
  return summary;
}

std::string DescribePriors(std::span<const TrackedFrame> frames) {
  std::map<PriorUse, size_t> uses = CountPriors(frames);
  if (uses[PriorUse::kNone] == frames.size()) {
    return {};
  }
  return fmt::format("odometry: used with the landmarks of {}, alone in {}, contradicted by {}\n",
                     Counted(uses[PriorUse::kFused], "frame"),
                     Counted(uses[PriorUse::kAlone], "frame"),
                     Counted(uses[PriorUse::kDropped], "frame"));
}

ProvenanceSummary SummarizeSettings(const LoadedSettings& settings, const RunResult& result) {
  ProvenanceSummary provenance;
  provenance.settings_hash = HashSettings(settings.options);
  provenance.seed = settings.options.seed;
  if (settings.preset) {
    provenance.preset = settings.preset->name;
    for (const PresetOverride& replaced : settings.notes.preset_overrides) {
      provenance.preset_overrides.push_back({.key = replaced.key,
                                             .preset_value = replaced.preset_value,
                                             .value = replaced.value,
                                             .source = replaced.origin});
    }
  }
  provenance.interrupted = result.was_interrupted;
  provenance.input_failure = result.input_failure;
  return provenance;
}

std::map<std::string, size_t> CountChanges(const std::vector<ChangedObject>& changes) {
  std::map<std::string, size_t> counts;
  for (const ObjectChange change : kObjectChanges) {
    counts[std::string(ToString(change))] = static_cast<size_t>(
        std::count_if(changes.begin(), changes.end(),
                      [&](const ChangedObject& changed) { return changed.change == change; }));
  }
  return counts;
}

ObjectsSummary SummarizeObjects(const ObjectResults& report, const ObjectCounts& counts) {
  const MapFit fit = SummarizeFits(report);
  ObjectsSummary summary;
  summary.count = fit.objects;
  summary.siou_mean = fit.mean.siou;
  summary.siou_mask_mean = fit.mean.siou_mask;
  summary.mtd_mean_m2 = fit.mean.mtd_m2;
  summary.tangent_mean_px = fit.mean.tangent_px;
  summary.observations = fit.mean.observations;
  summary.candidates = report.candidates;
  summary.detections = counts.detections;
  summary.frames_with_masks = counts.frames_with_masks;
  summary.frames_without_masks = counts.frames_without_masks;
  summary.rejections = counts.rejections;
  if (report.changes) {
    summary.changes = CountChanges(*report.changes);
  }
  return summary;
}

std::string DescribeRunEnd(const RunResult& result, const System& system, size_t frames,
                           const RunSummary& summary) {
  if (result.input_failure) {
    return fmt::format("{}; the run ended after {} of {} frames, the results so far were written",
                       *result.input_failure, result.given, frames);
  }
  return result.was_interrupted
             ? fmt::format(
                   "the run was interrupted after {} of {} frames; the results so far were "
                   "written",
                   result.given, frames)
             : DescribeLoss(system, frames, summary);
}

}  // namespace hullslam
