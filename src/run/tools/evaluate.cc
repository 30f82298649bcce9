// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "eval/body_metrics.h"
#include "eval/object_metrics.h"
#include "files/plausible.h"
#include "files/staged_file.h"
#include "hullslam/eval/rpe.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "results/evaluation_report.h"
#include "results/finished_run.h"
#include "results/object_file.h"
#include "results/pose_file.h"
#include "results/scene_file.h"
#include "results/true_body_file.h"
#include "results/true_object_file.h"
#include "run/command_line.h"
#include "run/program.h"
#include "run/tools/commands.h"

namespace hullslam {
namespace {

const std::map<std::string, AlignmentKind>& Alignments() {
  static const std::map<std::string, AlignmentKind> alignments = {
      {"none", AlignmentKind::kNone}, {"se3", AlignmentKind::kSe3}, {"sim3", AlignmentKind::kSim3}};
  return alignments;
}

struct TrajectoryArguments {
  std::string groundtruth;
  std::string estimate;
  AteOptions ate;
  std::array<double, 2> truth_sigma = {0.0, 0.0};  // m, degrees
  bool fit_mount = false;
  bool json = false;
};

struct ObjectsArguments {
  std::filesystem::path run;
  // groundtruth_objects.json; with `truth`, a trajectory. Empty: none, or the usual trajectory.
  std::filesystem::path groundtruth;
  std::filesystem::path truth;  // true bodies; empty: none
  // The alignment of the run with the ground truth; absent: that of summary.json.
  std::optional<AlignmentKind> alignment;
  size_t min_masks = 30;  // least number of masks with which a true object counts as visible
  bool upright = false;   // compares the boxes of scene.json
  bool json = false;
  std::filesystem::path json_file;  // empty: print the JSON
};

// A file of KITTI has no stamps: its poses are those of the other file, one for one.
std::pair<PoseFile, PoseFile> ReadBoth(const TrajectoryArguments& arguments) {
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
  return {std::move(reference), std::move(estimate)};
}

CLI::App* AddTrajectoryCommand(CLI::App& app, TrajectoryArguments& arguments) {
  const std::map<std::string, PairingRule> tools = {{"tum", PairingRule::kTum},
                                                    {"evo", PairingRule::kEvo}};
  CLI::App* const command = app.add_subcommand(
      "trajectory", "absolute and relative error of a trajectory (TUM, EuRoC, VSLAM-LAB or KITTI)");
  command->add_option("GROUNDTRUTH", arguments.groundtruth, "true trajectory")->required();
  command->add_option("ESTIMATE", arguments.estimate, "estimated trajectory")->required();
  command
      ->add_option("--align", arguments.ate.alignment,
                   "alignment with the true trajectory: none, se3 (default) or sim3")
      ->transform(CLI::CheckedTransformer(Alignments()).description(""));
  command
      ->add_option("--tool", arguments.ate.pairing,
                   "tool whose rule pairs the poses: tum (default) or evo")
      ->transform(CLI::CheckedTransformer(tools).description(""));
  auto* const max_difference = command->add_option(
      "--max-diff", arguments.ate.max_difference,
      "largest time between two paired poses, s (default: 0.02 for tum, 0.01 for evo)");
  ExpectNumber(*max_difference, 1e-9, kMostSeconds);
  auto* const truth_sigma = command->add_option(
      "--truth-sigma", arguments.truth_sigma,
      "M,DEG: standard deviations of the true trajectory's own errors, for NEES (default: 0,0)");
  ExpectNumber(*truth_sigma->delimiter(','), 0.0, 180.0);
  command->add_flag("--fit-mount", arguments.fit_mount,
                    "for NEES, also fit how the true body is mounted on the camera, and its clock");
  command->add_flag("--json", arguments.json, "print the report as JSON");
  return command;
}

// Prints the absolute and relative errors of a trajectory. Throws InputError for bad files, and if
// no two poses of the trajectories can be paired.
void RunTrajectoryCommand(const TrajectoryArguments& arguments) {
  const auto [reference, estimate] = ReadBoth(arguments);
  const TrajectoryErrors errors = EvaluateTrajectory(
      reference.poses, estimate.poses, arguments.ate, estimate.covariances,
      {arguments.truth_sigma[0], arguments.truth_sigma[1] * std::numbers::pi / 180.0,
       arguments.fit_mount});
  if (!errors.ate.ok()) {
    throw InputError(arguments.estimate + ": " + errors.ate.failure);
  }
  PrintWarnings(errors.warnings);
  Print("{}", arguments.json ? TrajectoryErrorsJson(errors) + '\n' : TrajectoryErrorsText(errors));
}

// The alignment with the ground truth. Without a summary.json the unit of length is the metre.
AlignmentKind FindAlignment(const std::filesystem::path& run) {
  std::error_code error;
  return std::filesystem::exists(run / "summary.json", error) ? OpenFinishedRun(run).alignment
                                                              : AlignmentKind::kSe3;
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

// The true trajectory for --truth. Throws InputError if there is none.
Trajectory ReadTrueTrajectory(const ObjectsArguments& arguments, const Trajectory& run) {
  std::error_code error;
  std::filesystem::path path = arguments.groundtruth;
  if (path.empty()) {
    path = arguments.truth.parent_path() / "groundtruth.txt";
    if (!std::filesystem::exists(path, error)) {
      const FinishedRun finished = OpenFinishedRun(arguments.run);
      path = finished.Find(finished.sequence.path).value_or(finished.folder) / "groundtruth.txt";
    }
    if (!std::filesystem::exists(path, error)) {
      throw InputError(path.string() +
                       ": there is no true trajectory, give --groundtruth FILE or --align none");
    }
  }
  PoseFile file = ReadPoseFile(path);
  if (!file.has_stamps) {
    SetStamps(path, StampsOf(run), file);
  }
  PrintWarnings(file.notes);
  return std::move(file.poses);
}

// Replaces ellipsoids by the upright boxes of scene.json, if the objects have one.
void UseUprightBoxes(const std::filesystem::path& run, const Sim3& truth_from_map,
                     std::vector<MappedBody>& bodies) {
  for (const SceneObject& object : ReadScene(run / "scene.json").objects) {
    const auto body = std::ranges::find(bodies, object.id, &MappedBody::id);
    if (object.box && body != bodies.end()) {
      const Ellipsoid box =
          truth_from_map * Ellipsoid{object.box->world_from_box, object.box->half_extents};
      body->body = {BodyKind::kBox, box.world_from_object, box.half_axes};
    }
  }
}

// Compares the mapped objects with the bodies of --truth. Throws InputError for bad files, and if
// no pose of the run has a true pose at its time.
BodyEvaluation ReadAndEvaluateBodies(const ObjectsArguments& arguments, const ObjectResults& report,
                                     AlignmentKind alignment) {
  std::vector<TrueBody> truths = ReadTrueBodies(arguments.truth);
  for (TrueBody& truth : truths) {
    truth.is_counted &= truth.masks.value_or(arguments.min_masks) >= arguments.min_masks;
  }
  Sim3 truth_from_map;
  if (alignment != AlignmentKind::kNone) {
    const Trajectory run = ReadTrajectory(arguments.run / "trajectory.txt");
    const Trajectory groundtruth = ReadTrueTrajectory(arguments, run);
    const AteResult ate = EvaluateAte(groundtruth, run, {.alignment = alignment});
    if (!ate.ok()) {
      throw InputError((arguments.run / "trajectory.txt").string() + ": " + ate.failure);
    }
    truth_from_map = AlignWorlds({groundtruth, run, ate, alignment}, report);
  }
  std::vector<MappedBody> mapped = MappedBodies(report, truth_from_map);
  if (arguments.upright) {
    UseUprightBoxes(arguments.run, truth_from_map, mapped);
  }
  BodyEvaluation bodies = EvaluateBodies(std::move(truths), std::move(mapped));
  bodies.alignment = alignment;
  bodies.scale = truth_from_map.scale;
  if (bodies.mapped.empty()) {
    PrintWarnings({arguments.run.string() + ": has no mapped objects"});
  } else if (!bodies.have_common_class) {
    PrintWarnings({arguments.truth.string() + ": has no class of a mapped object"});
  }
  return bodies;
}

void AddObjectsCommand(CLI::App& app, ObjectsArguments& arguments) {
  CLI::App* const command =
      app.add_subcommand("objects", "how well the objects of a run fit their masks or the truth");
  command->add_option("RUN_DIR", arguments.run, "output folder of the run")->required();
  command->add_option(
      "--truth", arguments.truth,
      "true boxes and ellipsoids: a list, groundtruth_objects.json of make_synthetic, "
      "scene_gt.json of BOP, or obj_offline of Cube-Diorama (default: none)");
  command->add_option(
      "--groundtruth", arguments.groundtruth,
      "with --truth: the true trajectory (default: groundtruth.txt beside that file "
      "or in the sequence of the run); else groundtruth_objects.json of "
      "make_synthetic (default: no comparison with true objects)");
  command
      ->add_option("--align", arguments.alignment,
                   "alignment with the true trajectory: se3, sim3 (with scale) or, with --truth, "
                   "none (default: that of summary.json in RUN_DIR)")
      ->transform(CLI::CheckedTransformer(Alignments()).description(""));
  command->add_flag_callback(
      "--given-poses", [&] { arguments.alignment = AlignmentKind::kNone; },
      "the run had true poses: the same as --align none");
  command->add_flag("--upright", arguments.upright,
                    "with --truth: compare the upright boxes of scene.json, not the ellipsoids");
  command
      ->add_option("--min-masks", arguments.min_masks,
                   "a true object counts as visible if at least this many masks show it")
      ->check(CLI::Range(0, 1000000).description(""))
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--json",
          [&](const std::string& file) {
            arguments.json = true;
            arguments.json_file = file;
          },
          "print the report as JSON, or write it to FILE and print the tables")
      ->expected(0, 1)
      ->type_name("[FILE]");
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
  std::optional<BodyEvaluation> bodies;
  if (!arguments.truth.empty()) {
    bodies = ReadAndEvaluateBodies(arguments, report, alignment);
  } else if (arguments.alignment == AlignmentKind::kNone) {
    throw InputError("--align none and --given-poses need --truth FILE");
  } else if (!arguments.groundtruth.empty()) {
    const bool is_scaled = alignment == AlignmentKind::kSim3;
    truth = ReadAndEvaluateTruth(arguments, report,
                                 is_scaled ? AlignmentKind::kSim3 : AlignmentKind::kSe3);
  }
  if (arguments.json) {
    const std::string json = EvaluationJson(report, truth, bodies) + '\n';
    if (arguments.json_file.empty()) {
      Print("{}", json);
      return;
    }
    WriteFileAtomically(arguments.json_file, json);
  }
  Print("{}", EvaluationText(report, alignment, truth, bodies));
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
