// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "eval/object_metrics.h"
#include "files/plausible.h"
#include "hullslam/eval/rpe.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "results/evaluation_report.h"
#include "results/finished_run.h"
#include "results/object_file.h"
#include "results/pose_file.h"
#include "results/true_object_file.h"
#include "run/command_line.h"
#include "run/program.h"
#include "run/tools/commands.h"

namespace hullslam {
namespace {

struct TrajectoryArguments {
  std::string groundtruth;
  std::string estimate;
  AteOptions ate;
  bool json = false;
};

struct ObjectsArguments {
  std::filesystem::path run;
  std::filesystem::path groundtruth;  // groundtruth_objects.json; empty: none
  // The alignment of the run with the ground truth; absent: that of summary.json.
  std::optional<AlignmentKind> alignment;
  size_t min_masks = 30;  // least number of masks with which a true object counts as visible
  bool json = false;
};

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

// Prints the absolute and relative errors of a trajectory. Throws InputError for bad files, and if
// no two poses of the trajectories can be paired.
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
    Print("{}", TrajectoryErrorsText(errors));
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

// Empty if the folder has no sequence with masks.
std::vector<size_t> ReadSightings(const std::filesystem::path& folder,
                                  const std::vector<TrueObject>& truths,
                                  const PinholeCamera& camera, const Trajectory& groundtruth,
                                  const Trajectory& run) {
  if (!std::filesystem::exists(folder / "masks") || !std::filesystem::exists(folder / "rgb.txt")) {
    return {};
  }
  const ImageSequence sequence = OpenTumSequence(folder);
  const std::vector<MaskFrame> frames = MaskFrames(sequence);
  const auto source = OpenMasks({folder / "masks", "", camera.width, camera.height}, frames);
  return CountAllSightings(truths, camera, groundtruth, run, StampsOf(sequence.frames),
                           [&](size_t frame) { return source->Read(frames[frame]).masks; });
}

// Reads groundtruth_objects.json, and from the same folder groundtruth.txt and the masks. Throws
// InputError for bad files, and if no pose of the run has a true pose at its time. `alignment` is
// kSe3, or kSim3 if the unit of length of the run is not the metre.
TruthEvaluation ReadAndEvaluateTruth(const ObjectsArguments& arguments, const ObjectResults& report,
                                     AlignmentKind alignment) {
  const std::filesystem::path folder = arguments.groundtruth.parent_path();
  const Trajectory groundtruth = ReadTrajectory(folder / "groundtruth.txt");
  const Trajectory run = ReadTrajectory(arguments.run / "trajectory.txt");
  const AteResult ate = EvaluateAte(groundtruth, run, {.alignment = alignment});
  if (!ate.ok()) {
    throw InputError((arguments.run / "trajectory.txt").string() + ": " + ate.failure);
  }
  const TrueScene scene = ReadTrueScene(arguments.groundtruth);
  return EvaluateTruth(scene, {groundtruth, run, ate, alignment}, report,
                       ReadSightings(folder, scene.objects, report.camera, groundtruth, run),
                       arguments.min_masks);
}

void AddObjectsCommand(CLI::App& app, ObjectsArguments& arguments) {
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
}

// Prints how well the objects of a run fit their observations and, with ground truth, how near they
// are to the true objects. Throws InputError for bad files.
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
  Print("{}", EvaluationText(report, alignment, truth));
}

}  // namespace

int RunEvaluate(int argc, char** argv) {
  CLI::App app("Evaluates finished runs.", argv[0]);
  AddVersionAndExitCodes(app);
  TrajectoryArguments trajectory;
  ObjectsArguments objects;
  const CLI::App* const trajectory_command = AddTrajectoryCommand(app, trajectory);
  AddObjectsCommand(app, objects);
  app.require_subcommand(1);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  if (trajectory_command->parsed()) {
    RunTrajectoryCommand(trajectory);
  } else {
    RunObjectsCommand(objects);
  }
  return kDone;
}

}  // namespace hullslam
