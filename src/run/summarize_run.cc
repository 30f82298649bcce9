// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/summarize_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "eval/object_metrics.h"
#include "eval/reprojection_error.h"
#include "hullslam/eval/ate.h"
#include "hullslam/eval/rpe.h"
#include "hullslam/settings/settings.h"
#include "map/islands.h"
#include "masks/mask_all.h"
#include "run/git_revision.h"
#include "run/messages.h"

namespace hullslam {
namespace {

Trajectory Scaled(Trajectory trajectory, double scale) {
  for (StampedPose& pose : trajectory) {
    pose.world_from_cam.translation *= scale;
  }
  return trajectory;
}

// The scale of a monocular map is not known, so the alignment includes the scale.
AlignmentKind AlignmentOf(SensorKind sensor) {
  return sensor == SensorKind::kMonocular ? AlignmentKind::kSim3 : AlignmentKind::kSe3;
}

// Depth in a wrong unit, or a wrong baseline, gives a map of the wrong size, which nothing but the
// ground truth reveals.
void WarnOfScale(const Trajectory& groundtruth, const Trajectory& trajectory, double rmse,
                 SensorKind sensor) {
  constexpr double kMostDifference = 0.1;  // the depth of real cameras is wrong by up to 4 %
  constexpr double kMuchBetter = 0.5;
  AteOptions options;
  options.alignment = AlignmentKind::kSim3;
  const AteResult scaled = EvaluateAte(groundtruth, trajectory, options);
  const double scale = scaled.reference_from_estimate.scale;
  if (scaled.ok() && std::abs(scale - 1.0) > kMostDifference &&
      scaled.errors.rmse < kMuchBetter * rmse) {
    PrintError(
        "warning: the trajectory is {:.2g} times as large as the ground truth; is {} right?\n",
        1.0 / scale,
        sensor == SensorKind::kStereo ? "the baseline of the cameras" : "DepthMapFactor");
  }
}

void Evaluate(const Trajectory& groundtruth, const Trajectory& trajectory, SensorKind sensor,
              TrajectorySummary& summary) {
  AteOptions options;
  options.alignment = AlignmentOf(sensor);
  const AteResult ate = EvaluateAte(groundtruth, trajectory, options);
  if (!ate.ok()) {
    PrintError("warning: the trajectory error cannot be computed: {}\n", ate.failure);
    return;
  }
  if (const std::string missing = DescribeMissingPairs(ate); !missing.empty()) {
    PrintError("warning: {}\n", missing);
  }
  summary.ate_rmse_m = ate.errors.rmse;
  summary.scale = ate.reference_from_estimate.scale;
  summary.pairs = ate.pairs;
  if (options.alignment == AlignmentKind::kSe3) {
    WarnOfScale(groundtruth, trajectory, ate.errors.rmse, sensor);
  }
  const Trajectory scaled = Scaled(trajectory, ate.reference_from_estimate.scale);
  const RpeResult rpe = EvaluateRpe(groundtruth, scaled);
  if (const std::string swapped = DescribeSwappedRotations(groundtruth, scaled, rpe);
      !swapped.empty()) {
    PrintError("warning: {}\n", swapped);
  }
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
  AteOptions options;
  options.alignment = AlignmentOf(sensor);
  const AteResult ate = EvaluateAte(*groundtruth, trajectory, options);
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

void SummarizeProvenance(const RunArguments& arguments, const LoadedSettings& settings,
                         const ImageSequence& sequence, const RunResult& result,
                         ProvenanceSummary& provenance) {
  provenance.program = arguments.program;
  provenance.version = HULLSLAM_VERSION;
  provenance.git = GitRevision();
  provenance.settings_hash = HashSettings(settings.options);
  AddPreset(settings, provenance);
  provenance.seed = arguments.seed;
  provenance.pipeline = arguments.threaded ? "threaded" : "sequential";
  provenance.sequence = arguments.sequence.string();
  provenance.dataset = sequence.dataset;
  provenance.sequence_choices = sequence.choices;
  if (!arguments.masks.empty()) {
    provenance.masks = arguments.masks.string();
  }
  if (!arguments.mask_all.empty()) {
    provenance.mask_all = {.path = arguments.mask_all.string(),
                           .ignored = IgnoredShare(settings.options.mask_all)};
  }
  if (!arguments.mask_all_right.empty()) {
    provenance.mask_all_right = {.path = arguments.mask_all_right.string(),
                                 .ignored = IgnoredShare(settings.options.mask_all_right)};
  }
  if (!arguments.save_map.empty()) {
    provenance.map = arguments.save_map.string();
  }
  if (!arguments.load_map.empty()) {
    provenance.loaded_map = arguments.load_map.string();
  }
  provenance.interrupted = result.was_interrupted;
  provenance.input_failure = result.input_failure;
}

}  // namespace

RunSummary SummarizeRun(const RunArguments& arguments, const LoadedSettings& settings,
                        const ImageSequence& sequence, const RunResult& result,
                        const System& system, const std::optional<Trajectory>& groundtruth) {
  const SystemOptions& options = settings.options;
  RunSummary summary;
  summary.trajectory.alignment = ToString(AlignmentOf(options.sensor));
  summary.trajectory.frames = result.given;
  summary.trajectory.skipped = result.skipped;
  summary.trajectory.unpaired = sequence.unpaired;
  summary.trajectory.lost = CountLost(system);
  summary.trajectory.tracked = system.frames().size() - summary.trajectory.lost;
  summary.trajectory.coverage =
      static_cast<double>(summary.trajectory.tracked) / static_cast<double>(sequence.frames.size());
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
    if (options.sensor == SensorKind::kMonocular && !options.objects.sizes.empty()) {
      summary.map.known_sizes = system.sized_objects();
    }
  }
  if (options.sensor == SensorKind::kMonocular && arguments.load_map.empty()) {
    summary.initialisation = result.initialisation;
  }
  SummarizeProvenance(arguments, settings, sequence, result, summary.provenance);
  const Trajectory trajectory = system.trajectory();
  if (groundtruth && !trajectory.empty()) {
    Evaluate(*groundtruth, trajectory, options.sensor, summary.trajectory);
  }
  summary.islands = SummarizeIslands(system, trajectory, groundtruth, options.sensor);
  return summary;
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

}  // namespace hullslam
