// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/evaluation_json.h"

#include "eval/object_metrics.h"
#include "results/json_text.h"

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

}  // namespace

std::string TrajectoryErrorsJson(const TrajectoryErrors& errors) {
  const AteResult& ate = errors.ate;
  const AteOptions& options = errors.options;
  const Json json = {
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
  return json.dump(2);
}

std::string EvaluationJson(const ObjectResults& report,
                           const std::optional<TruthEvaluation>& truth) {
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
                     {"groundtruth", truth ? ToJson(*truth) : Json(nullptr)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace hullslam
