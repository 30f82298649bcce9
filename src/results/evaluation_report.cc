// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/evaluation_report.h"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <string>

#include "eval/object_metrics.h"
#include "results/json_text.h"
#include "results/run_report.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const ErrorStatistics& errors) {
  return {
      {"rmse", errors.rmse}, {"mean", errors.mean}, {"median", errors.median}, {"max", errors.max}};
}

Json ToJson(const RpeResult& rpe) {
  if (!rpe.ok()) {
    return nullptr;
  }
  return {{"delta_s", 1.0},
          {"motions", rpe.motions},
          {"translation_m", ToJson(rpe.translation)},
          {"rotation_deg", ToJson(rpe.rotation)}};
}

Json FitJson(const ObjectResult& object) {
  return {{"id", object.id.value},
          {"class", object.label},
          {"state", ToString(object.state)},
          {"observations", object.fit.observations},
          {"lines", object.fit.lines},
          {"siou", OrNull(object.fit.siou)},
          {"siou_mask", OrNull(object.fit.siou_mask)},
          {"mtd_m2", OrNull(object.fit.mtd_m2)},
          {"tangent_px", OrNull(object.fit.tangent_px)},
          {"misfit_px", object.misfit_px}};
}

Json ToJson(const Eigen::Vector3d& values) { return {values.x(), values.y(), values.z()}; }

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
          {"siou_mean", OrNull(errors.siou_mean)}};
}

Json ToJson(const ObjectError& error) {
  return {{"object", error.object.value},
          {"center_m", error.center_m},
          {"center_share", error.center_share},
          {"axis_ratios", ToJson(error.axis_ratios)},
          {"extent_ratios", ToJson(error.extent_ratios)}};
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

constexpr double kDegrees = 180.0 / std::numbers::pi;

double TurnOf(const TruthOffset& offset) {
  return kDegrees * LogSo3(offset.cam_from_body.rotation).norm();
}

Json ToJson(const BodyScore& score) {
  return {{"least", score.least},
          {"truths", score.truths},
          {"predictions", score.predictions},
          {"right", score.right},
          {"precision", OrNull(score.precision)},
          {"ar", OrNull(score.recall)},
          {"ap", OrNull(score.average_precision)}};
}

Json ToJson(const std::array<BodyScore, 2>& scores) {
  return {{"25", ToJson(scores[0])}, {"50", ToJson(scores[1])}};
}

Json ToJson(const BodyErrors& errors) {
  return {{"count", errors.count},
          {"box_iou_mean", OrNull(errors.box_overlap)},
          {"solid_iou_mean", OrNull(errors.solid_overlap)},
          {"center_m", OrNull(errors.center_m)},
          {"longest", OrNull(errors.sorted_axes[0])},
          {"middle", OrNull(errors.sorted_axes[1])},
          {"shortest", OrNull(errors.sorted_axes[2])},
          {"axes_median", OrNull(errors.axes_median)},
          {"axes_mean", OrNull(errors.axes_mean)},
          {"towards", OrNull(errors.towards)},
          {"across", OrNull(errors.across)},
          {"turn_rad", OrNull(errors.turn)}};
}

Json ToJson(const BodyError& error, const BodyEvaluation& bodies) {
  const TrueBody& truth = bodies.truths[error.truth];
  return {{"id", truth.id},
          {"class", truth.label},
          {"shape", truth.shape},
          {"object", bodies.mapped[error.mapped].id.value},
          {"views", bodies.mapped[error.mapped].views},
          {"box_iou", error.box_overlap},
          {"solid_iou", error.solid_overlap},
          {"center_m", error.center_m},
          {"sorted_axes", ToJson(error.sorted_axes)},
          {"along_axes", ToJson(error.along_axes)},
          {"sight", ToJson(error.sight)},
          {"turn_rad", OrNull(error.turn)}};
}

Json ToJson(const BodyEvaluation& bodies) {
  Json each = Json::array();
  for (const BodyError& error : bodies.errors) {
    each.push_back(ToJson(error, bodies));
  }
  Json shapes = Json::object();
  for (const auto& [shape, errors] : ErrorsByShape(bodies)) {
    shapes[shape] = ToJson(errors);
  }
  const auto objects = [&](const std::vector<size_t>& indices) {
    Json ids = Json::array();
    for (const size_t index : indices) {
      ids.push_back(bodies.mapped[index].id.value);
    }
    return ids;
  };
  Json missed = Json::array();
  for (const size_t index : bodies.missed) {
    missed.push_back(bodies.truths[index].id);
  }
  return {{"alignment", ToString(bodies.alignment)},
          {"scale", bodies.scale},
          {"boxes", ToJson(bodies.boxes)},
          {"solids", ToJson(bodies.solids)},
          {"boxes_of_class", ToJson(bodies.boxes_of_class)},
          {"solids_of_class", ToJson(bodies.solids_of_class)},
          {"errors", ToJson(SummarizeBodyErrors(bodies.errors))},
          {"shapes", shapes},
          {"missed", missed},
          {"duplicates", objects(bodies.duplicates)},
          {"false", objects(bodies.false_ones)},
          {"each", each}};
}

std::string DescribeObject(const ObjectResult& object) {
  const ObjectFit& fit = object.fit;
  const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
  return fmt::format(
      "{:>4} {:<14} {:<9} {:>5} {:>6}  {:>6} {:>6} {:>9} {:>8} {:>7.1f}  {:.3f} {:.3f} {:.3f}{}\n",
      object.id.value, object.label, ToString(object.state), fit.observations, fit.lines,
      FormatFigure(fit.siou, 3), FormatFigure(fit.siou_mask, 3), FormatFigure(fit.mtd_m2, 6),
      FormatFigure(fit.tangent_px, 2), object.misfit_px, axes.x(), axes.y(), axes.z(),
      object.NameAtEnd());
}

std::string DescribeFits(const ObjectResults& report, AlignmentKind alignment) {
  std::string text;
  const std::string unit = alignment == AlignmentKind::kSim3 ? "u" : "m";
  text += fmt::format("{:>4} {:<14} {:<9} {:>5} {:>6}  {:>6} {:>6} {:>9} {:>8} {:>7}  {}\n", "id",
                      "class", "state", "views", "lines", "SIoU", "mask", "MTD " + unit + "2",
                      "tang. px", "misfit", "half axes " + unit);
  for (const ObjectResult& object : report.objects) {
    text += DescribeObject(object);
  }
  const MapFit fit = SummarizeFits(report);
  text +=
      fmt::format("\n{} mapped, {} not mapped; {} observations and {} lines of mapped objects\n",
                  fit.objects, report.candidates, fit.mean.observations, fit.mean.lines);
  text += fmt::format(
      "mean SIoU {} with hulls, {} with masks; mean MTD {} {}2; mean tangent distance {} px\n",
      FormatFigure(fit.mean.siou, 4), FormatFigure(fit.mean.siou_mask, 4),
      FormatFigure(fit.mean.mtd_m2, 6), unit, FormatFigure(fit.mean.tangent_px, 2));
  if (alignment == AlignmentKind::kSim3) {
    text += fmt::format(
        "u is the unit of length of the map, which a monocular run does not know in metres\n");
  }
  return text;
}

std::string DescribeRatios(const Eigen::Vector3d& ratios) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", ratios.x(), ratios.y(), ratios.z());
}

std::string DescribeChange(const char* kind, const ChangeCounts& counts) {
  return fmt::format("{:<12} {} in truth, {} reported, {} of them right\n", kind, counts.in_truth,
                     counts.reported, counts.right);
}

std::string DescribeTrueObject(const TruthEvaluation& evaluation, size_t index) {
  std::string text;
  const TrueObject& truth = evaluation.truths[index];
  const std::string masks = evaluation.sightings.empty()
                                ? std::string("-")
                                : fmt::format("{}", evaluation.sightings[index]);
  const std::string name =
      fmt::format("{:>4} {:<14} {:<12} {:>5}", truth.id, truth.label, truth.shape, masks);
  if (evaluation.comparison.times_mapped[index] == 0) {
    return fmt::format("{}  {}\n", name, truth.is_dynamic ? "not mapped (it moves)" : "not mapped");
  }
  for (const ObjectError& error : evaluation.comparison.errors) {
    if (error.truth == index) {
      text += fmt::format("{}  {:>4}  {:>6.1f} {:>6.1f}  {}  {}\n", name, error.object.value,
                          1e3 * error.center_m, 100.0 * error.center_share,
                          DescribeRatios(error.axis_ratios), DescribeRatios(error.extent_ratios));
    }
  }
  return text;
}

std::string DescribeTruth(const TruthEvaluation& evaluation) {
  std::string text = fmt::format(
      "\ntrue objects, after {} alignment of the poses with scale {:.6f} (ATE RMSE of the run "
      "{:.4f} m)\n",
      ToString(evaluation.alignment), evaluation.scale, evaluation.ate_rmse_m);
  text += fmt::format("{:>4} {:<14} {:<12} {:>5}  {:>4}  {:>6} {:>6}  {:<17}  {}\n", "id", "class",
                      "shape", "masks", "id", "mm", "% size", "axes, mapped/true",
                      "extents, mapped/true");
  for (size_t i = 0; i < evaluation.truths.size(); ++i) {
    text += DescribeTrueObject(evaluation, i);
  }
  const TruthCounts& counts = evaluation.counts;
  text += fmt::format(
      "{} visible ({}): {} mapped once, {} more than once, {} never; {} mapped objects match no "
      "true "
      "object\n",
      counts.visible,
      evaluation.sightings.empty() ? std::string("all of them, as the sequence has no masks")
                                   : fmt::format("in {} masks or more", evaluation.min_masks),
      counts.once, counts.more, counts.never, evaluation.comparison.without_truth.size());
  for (const auto& [shape, errors] : SummarizeByShape(evaluation.truths, evaluation.comparison)) {
    text += fmt::format(
        "{:<12} {} mapped: mean centre error {:.1f} % of the size (largest {:.1f} %), mean ratio "
        "of "
        "mapped to true axes {:.3f} (largest error {:.1f} %), mean SIoU {}\n",
        shape, errors.objects, 100.0 * errors.center_share_mean, 100.0 * errors.center_share_max,
        errors.axis_ratio_mean, 100.0 * errors.axis_ratio_deviation,
        FormatFigure(errors.siou_mean, 3));
  }
  if (evaluation.changes) {
    const ChangeComparison& changes = *evaluation.changes;
    text += fmt::format("{}{}{}{}{}", DescribeChange("moved", changes.moved),
                        DescribeChange("gone", changes.gone), DescribeChange("new", changes.added),
                        DescribeChange("places left", changes.left),
                        DescribeChange("places taken", changes.taken));
  }
  return text;
}

std::string DescribeScores(const char* name, const std::array<BodyScore, 2>& scores) {
  std::string text = fmt::format("{:<22}", name);
  for (const BodyScore& score : scores) {
    text += fmt::format("  {:>5} {:>5} {:>9}", FormatFigure(score.average_precision, 3),
                        FormatFigure(score.recall, 3), FormatFigure(score.precision, 3));
  }
  return text + '\n';
}

// The value as a multiple of the unit.
std::optional<double> In(double unit, const std::optional<double>& value) {
  return value ? std::optional(*value / unit) : std::nullopt;
}

std::string DescribeErrors(const std::string& shape, const BodyErrors& errors) {
  const auto percent = [](const std::optional<double>& value) {
    return FormatFigure(In(0.01, value), 1);
  };
  return fmt::format(
      "{:<12} {:>5}  {:>5} {:>5}  {:>6}  {:>6} {:>6} {:>6}  {:>6} {:>6}  {:>7} {:>6}  {:>5}\n",
      shape, errors.count, FormatFigure(errors.box_overlap, 3),
      FormatFigure(errors.solid_overlap, 3), FormatFigure(In(1e-3, errors.center_m), 1),
      percent(errors.sorted_axes[0]), percent(errors.sorted_axes[1]),
      percent(errors.sorted_axes[2]), percent(errors.axes_median), percent(errors.axes_mean),
      percent(errors.towards), percent(errors.across),
      FormatFigure(In(1.0 / kDegrees, errors.turn), 1));
}

std::string DescribeBodies(const BodyEvaluation& bodies) {
  std::string text = fmt::format(
      "\nbodies of the truth, after {} alignment with scale {:.6f}\n{:<22}  {:>5} {:>5} {:>9}  "
      "{:>5} "
      "{:>5} {:>9}\n",
      ToString(bodies.alignment), bodies.scale, "3D IoU", "AP25", "AR25", "precision", "AP50",
      "AR50", "precision");
  text += DescribeScores("boxes", bodies.boxes) +
          DescribeScores("boxes of one class", bodies.boxes_of_class) +
          DescribeScores("solids", bodies.solids) +
          DescribeScores("solids of one class", bodies.solids_of_class);
  text += fmt::format(
      "{} of {} bodies count: {} mapped, {} missed; {} duplicates, {} objects match none\n\n",
      bodies.boxes[0].truths, bodies.truths.size(), bodies.errors.size(), bodies.missed.size(),
      bodies.duplicates.size(), bodies.false_ones.size());
  text += fmt::format(
      "{:<12} {:>5}  {:>5} {:>5}  {:>6}  {:>6} {:>6} {:>6}  {:>6} {:>6}  {:>7} {:>6}  {:>5}\n",
      "shape", "pairs", "box", "solid", "mm", "long %", "mid %", "short%", "med. %", "mean %",
      "towards", "across", "deg");
  for (const auto& [shape, errors] : ErrorsByShape(bodies)) {
    text += DescribeErrors(shape, errors);
  }
  return text + DescribeErrors("all", SummarizeBodyErrors(bodies.errors));
}

double MaxDifference(const AteOptions& options) {
  return options.max_difference.value_or(DefaultMaxDifference(options.pairing));
}

std::string DescribeErrors(const char* name, const ErrorStatistics& errors, const char* unit) {
  return fmt::format("{:<12} rmse {:.6f}  mean {:.6f}  median {:.6f}  max {:.6f}  {}\n", name,
                     errors.rmse, errors.mean, errors.median, errors.max, unit);
}

}  // namespace

std::string TrajectoryErrorsJson(const TrajectoryErrors& errors) {
  const AteResult& ate = errors.ate;
  const AteOptions& options = errors.options;
  Json json = {
      {"ate_m", ToJson(ate.errors)},
      {"alignment", ToString(options.alignment)},
      {"scale", ate.reference_from_estimate.scale},
      {"pairing", ToString(options.pairing)},
      {"max_difference_s", options.max_difference.value_or(DefaultMaxDifference(options.pairing))},
      {"pairs", ate.pairs},
      {"coverage", ate.coverage},
      {"estimate_poses", ate.estimate_poses},
      {"groundtruth_poses", ate.reference_poses},
      {"paired_span_s", ate.paired_span},
      {"rpe", ToJson(errors.rpe)},
      {"scale_drift", OrNull(ate.scale_drift)}};
  if (errors.nees) {
    json["nees_over_6"] = {{"mean", errors.nees->ratio.mean},
                           {"median", errors.nees->ratio.median},
                           {"rotation_over_3_mean", errors.nees->rotation.mean},
                           {"translation_over_3_mean", errors.nees->translation.mean},
                           {"poses", errors.nees->poses}};
    if (const auto& offset = errors.nees->offset) {
      json["truth_offset"] = {{"rotation_deg", TurnOf(*offset)},
                              {"translation_m", offset->cam_from_body.translation.norm()},
                              {"clock_ahead_s", offset->clock_ahead}};
    }
  }
  return json.dump(2);
}

std::string EvaluationJson(const ObjectResults& report, const std::optional<TruthEvaluation>& truth,
                           const std::optional<BodyEvaluation>& bodies) {
  const MapFit fit = SummarizeFits(report);
  Json each = Json::array();
  for (const ObjectResult& object : report.objects) {
    each.push_back(FitJson(object));
  }
  const Json json = {{"count", fit.objects},
                     {"siou_mean", OrNull(fit.mean.siou)},
                     {"siou_mask_mean", OrNull(fit.mean.siou_mask)},
                     {"mtd_mean_m2", OrNull(fit.mean.mtd_m2)},
                     {"tangent_mean_px", OrNull(fit.mean.tangent_px)},
                     {"observations", fit.mean.observations},
                     {"lines", fit.mean.lines},
                     {"candidates", report.candidates},
                     {"each", each},
                     {"groundtruth", truth ? ToJson(*truth) : Json(nullptr)},
                     {"truth", bodies ? ToJson(*bodies) : Json(nullptr)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string TrajectoryErrorsText(const TrajectoryErrors& errors) {
  const AteResult& ate = errors.ate;
  std::string text = DescribeErrors("ATE", ate.errors, "m");
  if (errors.rpe.ok()) {
    text += DescribeErrors("RPE 1 s", errors.rpe.translation, "m");
    text += DescribeErrors("RPE 1 s", errors.rpe.rotation, "deg");
  } else {
    text += fmt::format("{:<12} none: {}\n", "RPE 1 s", errors.rpe.failure);
  }
  text += fmt::format("{:<12} {} of the estimate, {} of the ground truth\n", "poses",
                      ate.estimate_poses, ate.reference_poses);
  text += fmt::format(
      "{:<12} {} ({}'s rule within {} s), coverage {:.1f} % of the estimate, {:.1f} s\n", "pairs",
      ate.pairs, ToString(errors.options.pairing), MaxDifference(errors.options),
      100.0 * ate.coverage, ate.paired_span);
  text += fmt::format("{:<12} {}, scale {:.6f}\n", "alignment", ToString(errors.options.alignment),
                      ate.reference_from_estimate.scale);
  if (ate.scale_drift) {
    text += fmt::format("{:<12} {:.2f} % from the first to the last tenth of the pairs\n",
                        "scale drift", 100.0 * *ate.scale_drift);
  }
  if (errors.nees) {
    text += fmt::format(
        "{:<12} {:.2f} mean (1 if the covariances are right), {:.2f} median, {} poses\n"
        "{:<12} {:.2f} mean of the rotation, {:.2f} of the position\n",
        "NEES / 6", errors.nees->ratio.mean, errors.nees->ratio.median, errors.nees->poses,
        "NEES / 3", errors.nees->rotation.mean, errors.nees->translation.mean);
    if (const auto& offset = errors.nees->offset) {
      text +=
          fmt::format("{:<12} body {:.2f} deg and {:.4f} m from the camera, clock {:.4f} s ahead\n",
                      "of the truth", TurnOf(*offset), offset->cam_from_body.translation.norm(),
                      offset->clock_ahead);
    }
  }
  return text;
}

std::string EvaluationText(const ObjectResults& report, AlignmentKind alignment,
                           const std::optional<TruthEvaluation>& truth,
                           const std::optional<BodyEvaluation>& bodies) {
  return DescribeFits(report, alignment) + (truth ? DescribeTruth(*truth) : std::string()) +
         (bodies ? DescribeBodies(*bodies) : std::string());
}

}  // namespace hullslam
