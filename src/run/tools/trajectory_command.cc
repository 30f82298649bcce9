// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "files/plausible.h"
#include "hullslam/eval/rpe.h"
#include "hullslam/util/error.h"
#include "results/evaluation_json.h"
#include "results/pose_file.h"
#include "run/command_line.h"
#include "run/messages.h"
#include "run/tools/evaluate.h"

namespace hullslam {
namespace {

std::vector<double> StampsOf(const Trajectory& trajectory) {
  std::vector<double> stamps;
  for (const StampedPose& pose : trajectory) {
    stamps.push_back(pose.timestamp);
  }
  return stamps;
}

// A file of KITTI has no stamps: its poses are those of the other file, one for one.
std::pair<Trajectory, Trajectory> ReadBoth(const TrajectoryArguments& arguments) {
  PoseFile reference = ReadPoseFile(arguments.groundtruth);
  PoseFile estimate = ReadPoseFile(arguments.estimate);
  if (!reference.has_stamps) {
    SetStamps(arguments.groundtruth, StampsOf(estimate.poses), reference);
  } else if (!estimate.has_stamps) {
    SetStamps(arguments.estimate, StampsOf(reference.poses), estimate);
  }
  for (const PoseFile* const file : {&reference, &estimate}) {
    PrintWarnings(file->notes);
  }
  return {std::move(reference.poses), std::move(estimate.poses)};
}

double MaxDifference(const AteOptions& options) {
  return options.max_difference.value_or(DefaultMaxDifference(options.pairing));
}

void PrintErrors(const char* name, const ErrorStatistics& errors, const char* unit) {
  Print("{:<12} rmse {:.6f}  mean {:.6f}  median {:.6f}  max {:.6f}  {}\n", name, errors.rmse,
        errors.mean, errors.median, errors.max, unit);
}

void PrintText(const TrajectoryErrors& evaluation) {
  const AteResult& ate = evaluation.ate;
  PrintErrors("ATE", ate.errors, "m");
  if (evaluation.rpe.ok()) {
    PrintErrors("RPE 1 s", evaluation.rpe.translation, "m");
    PrintErrors("RPE 1 s", evaluation.rpe.rotation, "deg");
  } else {
    Print("{:<12} none: {}\n", "RPE 1 s", evaluation.rpe.failure);
  }
  Print("{:<12} {} of the estimate, {} of the ground truth\n", "poses", ate.estimate_poses,
        ate.reference_poses);
  Print("{:<12} {} ({}'s rule within {} s), coverage {:.1f} % of the estimate, {:.1f} s\n", "pairs",
        ate.pairs, ToString(evaluation.options.pairing), MaxDifference(evaluation.options),
        100.0 * ate.coverage, ate.paired_span);
  Print("{:<12} {}, scale {:.6f}\n", "alignment", ToString(evaluation.options.alignment),
        ate.reference_from_estimate.scale);
  if (ate.scale_drift) {
    Print("{:<12} {:.2f} % from the first to the last tenth of the pairs\n", "scale drift",
          100.0 * *ate.scale_drift);
  }
}

}  // namespace

CLI::App* AddTrajectoryCommand(CLI::App& app, TrajectoryArguments& arguments) {
  const std::map<std::string, AlignmentKind> alignments = {
      {"none", AlignmentKind::kNone}, {"se3", AlignmentKind::kSe3}, {"sim3", AlignmentKind::kSim3}};
  const std::map<std::string, PairingRule> tools = {{"tum", PairingRule::kTum},
                                                    {"evo", PairingRule::kEvo}};
  CLI::App* const command = app.add_subcommand(
      "trajectory", "absolute and relative error of a trajectory (TUM, EuRoC, VSLAM-LAB or KITTI)");
  command->add_option("GROUNDTRUTH", arguments.groundtruth, "true trajectory")->required();
  command->add_option("ESTIMATE", arguments.estimate, "estimated trajectory")->required();
  command
      ->add_option("--align", arguments.ate.alignment,
                   "alignment with the true trajectory: none, se3 (default) or sim3")
      ->transform(CLI::CheckedTransformer(alignments).description(""));
  command
      ->add_option("--tool", arguments.ate.pairing,
                   "tool whose rule pairs the poses: tum (default) or evo")
      ->transform(CLI::CheckedTransformer(tools).description(""));
  auto* const max_difference = command->add_option(
      "--max-diff", arguments.ate.max_difference,
      "largest time between two paired poses, s (default: 0.02 for tum, 0.01 for evo)");
  ExpectNumber(*max_difference, 1e-9, kMostSeconds);
  command->add_flag("--json", arguments.json, "print the report as JSON");
  return command;
}

void RunTrajectoryCommand(const TrajectoryArguments& arguments) {
  const auto [reference, estimate] = ReadBoth(arguments);
  const TrajectoryErrors errors = EvaluateTrajectory(reference, estimate, arguments.ate);
  if (!errors.ate.ok()) {
    throw InputError(arguments.estimate + ": " + errors.ate.failure);
  }
  PrintWarnings(errors.warnings);
  if (arguments.json) {
    Print("{}\n", TrajectoryErrorsJson(errors));
  } else {
    PrintText(errors);
  }
}

}  // namespace hullslam
