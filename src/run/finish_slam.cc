// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/finish_slam.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "eval/object_metrics.h"
#include "hullslam/results/trajectory_file.h"
#include "map/located_landmarks.h"
#include "results/object_file.h"
#include "results/ply_file.h"
#include "results/summary.h"
#include "run/map_session.h"
#include "run/mcap_output.h"
#include "run/print_results.h"
#include "run/program.h"
#include "run/report_output.h"
#include "run/summarize_run.h"
#include "scene/make_scene.h"
#include "system/compose_trajectory.h"
#include "system/make_sensor.h"

namespace hullslam {
namespace {

// The results of a run, from which its files are made.
struct RunContent {
  std::shared_ptr<const Map> map;  // not null
  Trajectory trajectory;
  LocatedLandmarks landmarks;
  ObjectResults objects;
  RunSummary summary;
};

// Adds the network of --segment and its times.
void SummarizeNetwork(const EndedRun& run, RunSummary& summary) {
  const NetworkMasks* const network = run.masks.network();
  if (network == nullptr) {
    return;
  }
  const NetworkMasks::Work work = network->work();
  summary.provenance.network =
      NetworkSummary{.path = network->path().string(),
                     .hash = network->hash(),
                     .every = network->every() > 0 ? std::optional(network->every()) : std::nullopt,
                     .classes = network->class_names(),
                     .images = work.times.Total("segment").count,
                     .failures = work.failures};
  summary.timing.stages_ms.merge(SummarizeStages(work.times));
}

RunContent CollectContent(const EndedRun& run) {
  const SystemOptions& options = run.settings.options;
  RunContent content;
  content.summary = SummarizeRun(run.arguments, run.settings, run.sequence, run.result, run.system,
                                 run.groundtruth);
  content.summary.provenance.masks_format = run.masks.format();
  SummarizeNetwork(run, content.summary);
  content.trajectory = run.system.trajectory();
  content.map = run.system.map() != nullptr ? run.system.map() : std::make_shared<const Map>();
  content.objects = MeasuredObjects(*content.map, options.camera, run.arguments.sequence);
  if (content.map->sessions().size() > run.earlier_sessions && run.earlier_sessions > 0) {
    content.objects.changes = run.system.object_changes();
  }
  if (run.masks.format()) {
    content.summary.objects = SummarizeObjects(content.objects, run.system.object_counts());
  }
  content.landmarks = LocateLandmarks(*content.map, MakeSensor(options));
  content.summary.map.landmarks_at_infinity = content.landmarks.at_infinity;
  return content;
}

std::string MapPly(const std::vector<Eigen::Vector3d>& landmarks, const Trajectory& keyframes) {
  std::vector<Eigen::Vector3d> centers;
  for (const StampedPose& pose : keyframes) {
    centers.push_back(pose.world_from_cam.translation);
  }
  return FormatMapPly(landmarks, centers);
}

// The islands that have files of their own.
std::span<const LeftIsland> KeptIslands(const EndedRun& run) {
  return run.arguments.keep_islands ? std::span(run.system.left_islands())
                                    : std::span<const LeftIsland>();
}

// Each island that was not joined has files of its own, named by its number.
void WriteIslands(OutputFolder& output, std::span<const LeftIsland> islands, const Sensor& sensor,
                  const ImageSequence& sequence) {
  for (const LeftIsland& island : islands) {
    const std::string name = IslandSuffix(island.id);
    const Trajectory keyframes = KeyframeTrajectory(*island.map);
    output.Write(
        {"trajectory" + name + ".txt", FormatTrajectory(AsRead(sequence, island.trajectory))});
    output.Write({"keyframes" + name + ".txt", FormatTrajectory(AsRead(sequence, keyframes))});
    output.Write(
        {"map" + name + ".ply", MapPly(LocateLandmarks(*island.map, sensor).positions, keyframes)});
  }
}

void WriteFiles(const EndedRun& run, const RunContent& content, OutputFolder& output) {
  const Map& map = *content.map;
  output.Write(
      {"trajectory.txt", FormatTrajectory(RunParts(run.arguments, run.earlier_sessions,
                                                   AsRead(run.sequence, content.trajectory)))});
  std::vector<TrajectoryPart> keyframes = KeyframeParts(run.arguments, map);
  for (TrajectoryPart& part : keyframes) {
    part.poses = AsRead(run.sequence, std::move(part.poses));
  }
  output.Write({"keyframes.txt", FormatTrajectory(keyframes)});
  output.Write({"map.ply", MapPly(content.landmarks.positions, KeyframeTrajectory(map))});
  WriteIslands(output, KeptIslands(run), MakeSensor(run.settings.options), run.sequence);
  if (run.sequence.converted_groundtruth) {
    output.Write({"groundtruth.txt", FormatTrajectory(*run.sequence.converted_groundtruth)});
  }
  if (run.masks.format()) {
    const Scene scene = MakeScene(map, content.objects, run.groundtruth);
    for (const FileContent& file : ObjectFiles(content.objects, scene)) {
      output.Write(file);
    }
  }
  RunSummary summary = content.summary;
  summary.files = output.names();
  output.Write({"summary.json", FormatSummary(summary)});
  output.Commit();
}

std::string DescribeInterruption(const RunResult& result, const ImageSequence& sequence) {
  return fmt::format(
      "the run was interrupted after {} of {} frames; the results so far were written",
      result.given, sequence.frames.size());
}

// Why the run failed; empty if it did not.
std::string DescribeFailure(const EndedRun& run, const RunSummary& summary) {
  if (run.result.input_failure) {
    return fmt::format("{}; the run ended after {} of {} frames, the results so far were written",
                       *run.result.input_failure, run.result.given, run.sequence.frames.size());
  }
  return run.result.was_interrupted
             ? DescribeInterruption(run.result, run.sequence)
             : DescribeLoss(run.arguments, run.settings.options.run, run.sequence.frames.size(),
                            summary, run.system.frames());
}

}  // namespace

int FinishSlam(const EndedRun& run, OutputFolder& output, LiveOutput& live) {
  const RunArguments& arguments = run.arguments;
  const SystemOptions& options = run.settings.options;
  const RunContent content = CollectContent(run);
  WriteFiles(run, content, output);
  const std::string unsaved = SaveMap(arguments, options, *content.map);
  const std::string unsaved_islands = SaveIslands(arguments, options, KeptIslands(run));
  const std::string unrecorded =
      WriteMcap(arguments, {.writer = fmt::format("hullslam {}", HULLSLAM_VERSION),
                            .options = &options,
                            .map = content.map.get(),
                            .sequence = &run.sequence,
                            .frames = run.result.given,
                            .trajectory = &content.trajectory,
                            .objects = &content.objects});
  if (!arguments.quiet) {
    PrintResults(arguments, content.summary, content.objects);
  }
  live.End(content.map, SummaryJson(content.summary));
  const std::string unreported =
      arguments.report
          ? WriteReport(output.path(), *content.map, options, run.sequence, arguments.quiet)
          : "";
  const int code = FailIfAny(
      {DescribeFailure(run, content.summary), unsaved, unsaved_islands, unrecorded, unreported});
  return run.result.input_failure ? kBadInput : code;
}

}  // namespace hullslam
