// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <system_error>

#include "eval/object_metrics.h"
#include "hullslam/util/error.h"
#include "results/evaluation_json.h"
#include "results/finished_run.h"
#include "results/object_file.h"
#include "run/messages.h"
#include "run/print_results.h"
#include "run/tools/evaluate.h"

namespace hullslam {
namespace {

void PrintObject(const ObjectResult& object) {
  const ObjectFit& fit = object.fit;
  const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
  Print("{:>4} {:<14} {:<9} {:>5} {:>6}  {:>6} {:>6} {:>9} {:>8} {:>7.1f}  {:.3f} {:.3f} {:.3f}\n",
        object.id.value, object.label, ToString(object.state), fit.observations, fit.lines,
        FormatFigure(fit.siou, 3), FormatFigure(fit.siou_mask, 3), FormatFigure(fit.mtd_m2, 6),
        FormatFigure(fit.tangent_px, 2), object.misfit_px, axes.x(), axes.y(), axes.z());
}

// Prints the objects. Lengths are in metres or, if the alignment has a scale, in "u", the unit of
// length of the map.
void PrintText(const ObjectResults& report, AlignmentKind alignment) {
  const std::string unit = alignment == AlignmentKind::kSim3 ? "u" : "m";
  Print("{:>4} {:<14} {:<9} {:>5} {:>6}  {:>6} {:>6} {:>9} {:>8} {:>7}  {}\n", "id", "class",
        "state", "views", "lines", "SIoU", "mask", "MTD " + unit + "2", "tang. px", "misfit",
        "half axes " + unit);
  for (const ObjectResult& object : report.objects) {
    PrintObject(object);
  }
  const MapFit fit = SummarizeFits(report);
  Print("\n{} mapped, {} not mapped; {} observations and {} lines of mapped objects\n", fit.objects,
        report.candidates, fit.mean.observations, fit.mean.lines);
  Print("mean SIoU {} with hulls, {} with masks; mean MTD {} {}2; mean tangent distance {} px\n",
        FormatFigure(fit.mean.siou, 4), FormatFigure(fit.mean.siou_mask, 4),
        FormatFigure(fit.mean.mtd_m2, 6), unit, FormatFigure(fit.mean.tangent_px, 2));
  if (alignment == AlignmentKind::kSim3) {
    Print("u is the unit of length of the map, which a monocular run does not know in metres\n");
  }
}

// The alignment with the ground truth. Without a summary.json the unit of length is the metre.
AlignmentKind FindAlignment(const std::filesystem::path& run) {
  std::error_code error;
  const bool is_scaled =
      std::filesystem::exists(run / "summary.json", error) && !OpenFinishedRun(run).IsMetric();
  return is_scaled ? AlignmentKind::kSim3 : AlignmentKind::kSe3;
}

void CheckHasObjects(const std::filesystem::path& run) {
  std::error_code error;
  if (!std::filesystem::exists(run / "objects.json", error) &&
      std::filesystem::exists(run / "summary.json", error)) {
    throw InputError(
        run.string() +
        ": this run had no masks, so it has no objects (objects.json); give the program "
        "that makes the run --masks");
  }
}

}  // namespace

CLI::App* AddObjectsCommand(CLI::App& app, ObjectsArguments& arguments) {
  const std::map<std::string, AlignmentKind> alignments = {{"se3", AlignmentKind::kSe3},
                                                           {"sim3", AlignmentKind::kSim3}};
  CLI::App* const command =
      app.add_subcommand("objects", "SIoU, MTD and tangent distance of the objects of a run");
  command->add_option("RUN_DIR", arguments.run, "output folder of the run")->required();
  command->add_option("--groundtruth", arguments.groundtruth,
                      "groundtruth_objects.json of the sequence, which make_synthetic wrote "
                      "(default: no comparison with true objects)");
  command
      ->add_option("--align", arguments.alignment,
                   "alignment with the true trajectory: se3 or sim3, with scale (default: sim3 if "
                   "summary.json in RUN_DIR says that the run was monocular, else se3)")
      ->transform(CLI::CheckedTransformer(alignments).description(""));
  command
      ->add_option("--min-masks", arguments.min_masks,
                   "a true object counts as visible if at least this many masks show it")
      ->check(CLI::Range(0, 1000000).description(""))
      ->capture_default_str();
  command->add_flag("--json", arguments.json, "print the report as JSON");
  return command;
}

void RunObjectsCommand(const ObjectsArguments& arguments) {
  CheckHasObjects(arguments.run);
  ObjectResults report = ReadObjects(arguments.run / "objects.json");
  MeasureObjects(report);
  const AlignmentKind alignment =
      arguments.alignment ? *arguments.alignment : FindAlignment(arguments.run);
  std::optional<TruthEvaluation> truth;
  if (!arguments.groundtruth.empty()) {
    truth = ReadAndEvaluateTruth(arguments, report, alignment);
  }
  if (arguments.json) {
    Print("{}\n", EvaluationJson(report, truth));
    return;
  }
  PrintText(report, alignment);
  if (truth) {
    PrintTruth(*truth);
  }
}

}  // namespace hullslam
