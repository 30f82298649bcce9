// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/run_files.h"
#include "masks/mask_all.h"
#include "results/run_report.h"
#include "results/summary.h"
#include "run/more_outputs.h"
#include "run/program.h"
#include "run/slam_run.h"

namespace hullslam {
namespace {

// The path; absent if it is empty.
std::optional<std::string> Given(const std::filesystem::path& path) {
  return path.empty() ? std::nullopt : std::optional(path.string());
}

std::optional<MaskAllSummary> SummarizeMaskAll(const std::filesystem::path& path,
                                               const cv::Mat& mask) {
  return path.empty() ? std::nullopt
                      : std::optional<MaskAllSummary>(
                            {.path = path.string(), .ignored = IgnoredShare(mask)});
}

ProvenanceSummary SummarizeProvenance(const SlamRun& run, const RunResult& result) {
  const RunArguments& arguments = run.arguments;
  ProvenanceSummary provenance = SummarizeSettings(run.settings, result);
  provenance.program = arguments.program;
  provenance.version = HULLSLAM_VERSION;
  provenance.git = GitRevision();
  provenance.pipeline = arguments.threaded ? "threaded" : "sequential";
  provenance.sequence = arguments.sequence.string();
  provenance.dataset = run.sequence.dataset;
  provenance.sequence_choices = run.sequence.choices;
  provenance.masks = Given(arguments.masks);
  provenance.masks_format = run.masks.format();
  provenance.mask_all = SummarizeMaskAll(arguments.mask_all, run.settings.options.mask_all);
  provenance.mask_all_right =
      SummarizeMaskAll(arguments.mask_all_right, run.settings.options.mask_all_right);
  provenance.map = Given(arguments.save_map);
  provenance.loaded_map = Given(arguments.load_map);
  return provenance;
}

// The content of summary.json but for masks and objects.
RunSummary Summarize(const SlamRun& run, const RunResult& result) {
  std::vector<std::string> warnings;
  RunSummary summary = SummarizeRun(result, run.system, run.groundtruth, warnings);
  PrintWarnings(warnings);
  summary.trajectory.unpaired = run.sequence.unpaired;
  summary.trajectory.coverage = static_cast<double>(summary.trajectory.tracked) /
                                static_cast<double>(run.sequence.frames.size());
  if (!run.arguments.load_map.empty()) {
    summary.initialisation.reset();
  }
  summary.provenance = SummarizeProvenance(run, result);
  return summary;
}

RunSummary SummarizeAll(const SlamRun& run, const RunResult& result, const RunContent& content) {
  RunSummary summary = Summarize(run, result);
  if (const NetworkMasks* const network = run.masks.network(); network != nullptr) {
    summary.provenance.network = SummarizeNetwork(*network);
    summary.timing.stages_ms.merge(SummarizeStages(network->work().times));
  }
  if (run.masks.format()) {
    summary.objects = SummarizeObjects(content.objects, run.system.object_counts());
  }
  summary.map.landmarks_at_infinity = content.landmarks.at_infinity;
  return summary;
}

void WriteFiles(const SlamRun& run, const RunContent& content, RunSummary summary) {
  OutputFolder& output = run.output;
  WriteRunFiles({.content = content,
                 .sequence = run.sequence,
                 .options = run.settings.options,
                 .session = SessionTitle(run.arguments, run.earlier_sessions),
                 .has_objects = run.masks.format().has_value()},
                output);
  summary.files = output.names();
  output.Write({"summary.json", FormatSummary(summary)});
  output.Commit();
}

}  // namespace

int FinishSlam(const SlamRun& run, const RunResult& result) {
  const RunArguments& arguments = run.arguments;
  const SystemOptions& options = run.settings.options;
  const RunContent content = CollectContent(run.system, arguments.sequence, run.groundtruth,
                                            run.earlier_sessions, arguments.keep_islands);
  const RunSummary summary = SummarizeAll(run, result, content);
  WriteFiles(run, content, summary);
  const std::string unsaved = SaveMap(arguments, options, *content.map);
  const std::string unsaved_islands = SaveIslands(arguments, options, content.islands);
  const std::string unrecorded =
      WriteMcap(arguments, {.writer = fmt::format("hullslam {}", HULLSLAM_VERSION),
                            .options = &options,
                            .map = content.map.get(),
                            .sequence = &run.sequence,
                            .frames = result.given,
                            .trajectory = &content.trajectory,
                            .objects = &content.objects,
                            .scene = &content.scene,
                            .live = result.live});
  if (!arguments.quiet) {
    Print("{}{}results are in {}\n", DescribePriors(run.system.frames()),
          DescribeRun(summary, content.objects, arguments.sensor, arguments.keep_islands),
          arguments.output.string());
  }
  run.live.End(content.map, SummaryJson(summary));
  const std::string unreported =
      arguments.report
          ? WriteReport(run.output.path(), *content.map, options, run.sequence, arguments.quiet)
          : "";
  const int code =
      FailIfAny({DescribeRunEnd(result, run.system, run.sequence.frames.size(), summary), unsaved,
                 unsaved_islands, unrecorded, unreported});
  return result.input_failure ? kBadInput : code;
}

}  // namespace hullslam
