// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <string>

#include "hullslam/eval/ate.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "results/true_object_file.h"
#include "run/messages.h"
#include "run/print_results.h"
#include "run/tools/evaluate.h"

namespace hullslam {
namespace {

std::string DescribeRatios(const Eigen::Vector3d& ratios) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", ratios.x(), ratios.y(), ratios.z());
}

std::string DescribeChange(const char* kind, const ChangeCounts& counts) {
  return fmt::format("{:<12} {} in truth, {} reported, {} of them right\n", kind, counts.in_truth,
                     counts.reported, counts.right);
}

void PrintTrueObject(const TruthEvaluation& evaluation, size_t index) {
  const TrueObject& truth = evaluation.truths[index];
  const std::string masks = evaluation.sightings.empty()
                                ? std::string("-")
                                : fmt::format("{}", evaluation.sightings[index]);
  const std::string name =
      fmt::format("{:>4} {:<14} {:<12} {:>5}", truth.id, truth.label, truth.shape, masks);
  if (evaluation.comparison.times_mapped[index] == 0) {
    Print("{}  {}\n", name, truth.is_dynamic ? "not mapped (it moves)" : "not mapped");
    return;
  }
  for (const ObjectError& error : evaluation.comparison.errors) {
    if (error.truth == index) {
      Print("{}  {:>4}  {:>6.1f} {:>6.1f}  {}  {}\n", name, error.object.value,
            1e3 * error.center_m, 100.0 * error.center_share, DescribeRatios(error.axis_ratios),
            DescribeRatios(error.extent_ratios));
    }
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
  std::vector<double> stamps;
  for (const FramePaths& frame : sequence.frames) {
    stamps.push_back(frame.timestamp);
  }
  return CountAllSightings(truths, camera, groundtruth, run, stamps,
                           [&](size_t frame) { return source->Read(frames[frame]).masks; });
}

}  // namespace

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

void PrintTruth(const TruthEvaluation& evaluation) {
  Print(
      "\ntrue objects, after {} alignment of the poses with scale {:.6f} (ATE RMSE of the run "
      "{:.4f} m)\n",
      ToString(evaluation.alignment), evaluation.scale, evaluation.ate_rmse_m);
  Print("{:>4} {:<14} {:<12} {:>5}  {:>4}  {:>6} {:>6}  {:<17}  {}\n", "id", "class", "shape",
        "masks", "id", "mm", "% size", "axes, mapped/true", "extents, mapped/true");
  for (size_t i = 0; i < evaluation.truths.size(); ++i) {
    PrintTrueObject(evaluation, i);
  }
  const TruthCounts& counts = evaluation.counts;
  Print(
      "{} visible ({}): {} mapped once, {} more than once, {} never; {} mapped objects match no "
      "true "
      "object\n",
      counts.visible,
      evaluation.sightings.empty() ? std::string("all of them, as the sequence has no masks")
                                   : fmt::format("in {} masks or more", evaluation.min_masks),
      counts.once, counts.more, counts.never, evaluation.comparison.without_truth.size());
  for (const auto& [shape, errors] : SummarizeByShape(evaluation.truths, evaluation.comparison)) {
    Print(
        "{:<12} {} mapped: mean centre error {:.1f} % of the size (largest {:.1f} %), mean ratio "
        "of "
        "mapped to true axes {:.3f} (largest error {:.1f} %), mean SIoU {}\n",
        shape, errors.objects, 100.0 * errors.center_share_mean, 100.0 * errors.center_share_max,
        errors.axis_ratio_mean, 100.0 * errors.axis_ratio_deviation,
        FormatFigure(errors.siou_mean, 3));
  }
  if (evaluation.changes) {
    const ChangeComparison& changes = *evaluation.changes;
    Print("{}{}{}{}{}", DescribeChange("moved", changes.moved),
          DescribeChange("gone", changes.gone), DescribeChange("new", changes.added),
          DescribeChange("places left", changes.left),
          DescribeChange("places taken", changes.taken));
  }
}

}  // namespace hullslam
