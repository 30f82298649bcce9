// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/tools/objects_truth.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "hullslam/eval/ate.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "results/true_object_file.h"
#include "run/messages.h"
#include "run/print_results.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

std::vector<SeenBox> BoxesOf(const std::vector<InstanceMask>& masks, const PinholeCamera& camera) {
  std::vector<SeenBox> boxes;
  for (const InstanceMask& mask : masks) {
    SeenBox seen{mask.label, {}};
    for (const std::vector<Eigen::Vector2d>& outline : mask.outlines) {
      for (const Eigen::Vector2d& point : outline) {
        seen.box.extend(camera.Undistort(point));
      }
    }
    boxes.push_back(seen);
  }
  return boxes;
}

// For each true object, the number of masks that show it in the frames of the run. Empty if the
// folder has no sequence with masks.
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
  for (const StampedPose& pose : groundtruth) {
    stamps.push_back(pose.timestamp);
  }
  std::vector<size_t> sightings(truths.size(), 0);
  for (size_t i = 0; i < frames.size(); ++i) {
    const double stamp = sequence.frames[i].timestamp;
    const size_t nearest = NearestStamp(stamps, stamp);
    const bool during = stamp >= run.front().timestamp && stamp <= run.back().timestamp;
    if (during && std::abs(stamps[nearest] - stamp) <= DefaultMaxDifference(PairingRule::kTum)) {
      CountSightings(truths, camera, Inverse(groundtruth[nearest].world_from_cam),
                     BoxesOf(source->Read(frames[i]).masks, camera), sightings);
    }
  }
  return sightings;
}

std::string DescribeRatios(const Eigen::Vector3d& ratios) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", ratios.x(), ratios.y(), ratios.z());
}

Json ToJson(const Eigen::Vector3d& values) { return {values.x(), values.y(), values.z()}; }

std::string DescribeChange(const char* kind, const ChangeCounts& counts) {
  return fmt::format("{:<12} {} in truth, {} reported, {} of them right\n", kind, counts.in_truth,
                     counts.reported, counts.right);
}

Json ToJson(const ChangeCounts& counts) {
  return {{"in_truth", counts.in_truth}, {"reported", counts.reported}, {"right", counts.right}};
}

Json ToJson(const std::optional<ChangeComparison>& changes) {
  if (!changes) {
    return nullptr;
  }
  return {{"moved", ToJson(changes->moved)},
          {"gone", ToJson(changes->gone)},
          {"new", ToJson(changes->added)},
          {"places_left", ToJson(changes->left)},
          {"places_taken", ToJson(changes->taken)}};
}

Json ToJson(const ShapeErrors& errors) {
  return {{"objects", errors.objects},
          {"center_share_mean", errors.center_share_mean},
          {"center_share_max", errors.center_share_max},
          {"axis_ratio_mean", errors.axis_ratio_mean},
          {"axis_ratio_deviation", errors.axis_ratio_deviation},
          {"siou_mean", errors.siou_mean ? Json(*errors.siou_mean) : Json(nullptr)}};
}

Json ToJson(const ObjectError& error) {
  return {{"object", error.object.value},
          {"center_m", error.center_m},
          {"center_share", error.center_share},
          {"axis_ratios", ToJson(error.axis_ratios)},
          {"extent_ratios", ToJson(error.extent_ratios)}};
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

Json ToJson(const TruthEvaluation& evaluation) {
  Json each = Json::array();
  for (size_t i = 0; i < evaluation.truths.size(); ++i) {
    const TrueObject& truth = evaluation.truths[i];
    Json mapped = Json::array();
    for (const ObjectError& error : evaluation.comparison.errors) {
      if (error.truth == i) {
        mapped.push_back(ToJson(error));
      }
    }
    each.push_back(
        {{"id", truth.id},
         {"class", truth.label},
         {"shape", truth.shape},
         {"dynamic", truth.is_dynamic},
         {"masks", evaluation.sightings.empty() ? Json(nullptr) : Json(evaluation.sightings[i])},
         {"mapped", mapped}});
  }
  Json shapes = Json::object();
  for (const auto& [shape, errors] : SummarizeByShape(evaluation.truths, evaluation.comparison)) {
    shapes[shape] = ToJson(errors);
  }
  Json without = Json::array();
  for (const ObjectId id : evaluation.comparison.without_truth) {
    without.push_back(id.value);
  }
  return {{"alignment", ToString(evaluation.alignment)},
          {"scale", evaluation.scale},
          {"ate_rmse_m", evaluation.ate_rmse_m},
          {"min_masks", evaluation.min_masks},
          {"visible", evaluation.counts.visible},
          {"once", evaluation.counts.once},
          {"more", evaluation.counts.more},
          {"never", evaluation.counts.never},
          {"without_truth", without},
          {"shapes", shapes},
          {"changes", ToJson(evaluation.changes)},
          {"each", each}};
}

}  // namespace hullslam
