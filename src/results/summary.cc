// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/summary.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "results/json_text.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const FrameStretch& stretch) {
  return {{"first_frame", stretch.first_frame},
          {"last_frame", stretch.last_frame},
          {"first_timestamp", stretch.first_timestamp},
          {"last_timestamp", stretch.last_timestamp},
          {"frames", stretch.frames}};
}

Json ToJson(const TrajectorySummary& summary) {
  Json losses = Json::array();
  for (const LostStretch& stretch : summary.losses) {
    losses.push_back(ToJson(stretch));
    losses.back()["reason"] = ToString(stretch.reason);
  }
  Json unsure = Json::array();
  for (const FrameStretch& stretch : summary.unsure) {
    unsure.push_back(ToJson(stretch));
  }
  return {{"ate_rmse_m", OrNull(summary.ate_rmse_m)},
          {"alignment", summary.alignment},
          {"scale", OrNull(summary.scale)},
          {"pairs", summary.pairs},
          {"frames", summary.frames},
          {"tracked", summary.tracked},
          {"lost", summary.lost},
          {"poses", summary.poses},
          {"pairing", summary.pairing},
          {"coverage", OrNull(summary.coverage)},
          {"rpe_rmse_m", OrNull(summary.rpe_rmse_m)},
          {"rpe_rmse_deg", OrNull(summary.rpe_rmse_deg)},
          {"skipped", summary.skipped},
          {"unpaired", summary.unpaired},
          {"losses", losses},
          {"unsure", unsure}};
}

Json ToJson(const ObjectsSummary& summary) {
  Json rejections = Json::object();
  for (const auto& [reason, count] : summary.rejections) {
    rejections[reason] = count;
  }
  return {{"count", summary.count},
          {"siou_mean", OrNull(summary.siou_mean)},
          {"siou_mask_mean", OrNull(summary.siou_mask_mean)},
          {"mtd_mean_m2", OrNull(summary.mtd_mean_m2)},
          {"tangent_mean_px", OrNull(summary.tangent_mean_px)},
          {"observations", summary.observations},
          {"candidates", summary.candidates},
          {"detections", summary.detections},
          {"frames_with_masks", summary.frames_with_masks},
          {"frames_without_masks", summary.frames_without_masks},
          {"rejections", rejections},
          {"changes", summary.changes ? Json(*summary.changes) : Json(nullptr)}};
}

Json ToJson(const InitialisationSummary& summary) {
  return {{"seconds", OrNull(summary.seconds)}, {"failures", Json(summary.failures)}};
}

Json ToJson(const IslandSummary& island) {
  return {{"number", island.number},
          {"main", island.is_main},
          {"keyframes", island.keyframes},
          {"landmarks", island.landmarks},
          {"frames", island.frames},
          {"first_timestamp", OrNull(island.first_timestamp)},
          {"last_timestamp", OrNull(island.last_timestamp)},
          {"ate_rmse_m", OrNull(island.ate_rmse_m)}};
}

Json ToJson(const IslandsSummary& summary) {
  Json at_end = Json::array();
  for (const IslandSummary& island : summary.at_end) {
    at_end.push_back(ToJson(island));
  }
  return {{"begun", summary.begun}, {"joined", summary.joined}, {"at_end", at_end}};
}

Json ToJson(const TimeStatistics& times) {
  return {{"median", times.median}, {"mean", times.mean}, {"p95", times.p95}, {"max", times.max}};
}

Json ToJson(const TimingSummary& summary) {
  Json stages = Json::object();
  for (const auto& [stage, times] : summary.stages_ms) {
    stages[stage] = ToJson(times);
  }
  return {{"track_ms", ToJson(summary.track_ms)},
          {"stages_ms", stages},
          {"total_s", summary.total_s},
          {"frames_per_second", summary.frames_per_second}};
}

Json ToJson(const MapSummary& summary) {
  return {{"keyframes", summary.keyframes},
          {"landmarks", summary.landmarks},
          {"landmarks_at_infinity", summary.landmarks_at_infinity},
          {"contradicted_landmarks", summary.contradicted_landmarks},
          {"loops", summary.loops},
          {"sessions", summary.sessions},
          {"reprojection_px", OrNull(summary.reprojection_px)},
          {"known_sizes", OrNull(summary.known_sizes)}};
}

Json ToJson(const PresetOverrideSummary& replaced) {
  return {{"key", replaced.key},
          {"preset_value", replaced.preset_value},
          {"value", replaced.value},
          {"source", replaced.source}};
}

Json ToJson(const std::optional<NetworkSummary>& network) {
  if (!network) {
    return nullptr;
  }
  return {{"path", network->path},           {"hash", network->hash},
          {"every", OrNull(network->every)}, {"classes", network->classes},
          {"images", network->images},       {"failures", network->failures}};
}

Json ToJson(const std::optional<MaskAllSummary>& mask) {
  return mask ? Json{{"path", mask->path}, {"ignored", mask->ignored}} : Json(nullptr);
}

Json ToJson(const ProvenanceSummary& summary) {
  Json overrides = Json::array();
  for (const PresetOverrideSummary& replaced : summary.preset_overrides) {
    overrides.push_back(ToJson(replaced));
  }
  return {{"program", OrNull(summary.program)},
          {"version", OrNull(summary.version)},
          {"git", OrNull(summary.git)},
          {"settings_hash", OrNull(summary.settings_hash)},
          {"preset", OrNull(summary.preset)},
          {"preset_overrides", overrides},
          {"seed", summary.seed},
          {"pipeline", summary.pipeline},
          {"masks", OrNull(summary.masks)},
          {"masks_format", OrNull(summary.masks_format)},
          {"network", ToJson(summary.network)},
          {"mask_all", ToJson(summary.mask_all)},
          {"mask_all_right", ToJson(summary.mask_all_right)},
          {"sequence", OrNull(summary.sequence)},
          {"dataset", OrNull(summary.dataset)},
          {"sequence_choices", Json(summary.sequence_choices)},
          {"map", OrNull(summary.map)},
          {"loaded_map", OrNull(summary.loaded_map)},
          {"interrupted", summary.interrupted},
          {"input_failure", OrNull(summary.input_failure)}};
}

}  // namespace

nlohmann::ordered_json SummaryJson(const RunSummary& summary) {
  Json json = {{"trajectory", ToJson(summary.trajectory)},
               {"objects", summary.objects ? ToJson(*summary.objects) : Json(nullptr)},
               {"timing", ToJson(summary.timing)},
               {"memory", {{"peak_mb", summary.peak_memory_mb}}},
               {"map", ToJson(summary.map)},
               {"provenance", ToJson(summary.provenance)},
               {"files", summary.files}};
  if (summary.initialisation) {
    json["initialisation"] = ToJson(*summary.initialisation);
  }
  if (summary.islands) {
    json["islands"] = ToJson(*summary.islands);
  }
  return json;
}

std::string FormatSummary(const RunSummary& summary) {
  constexpr int kIndent = 2;
  // The name of a folder may contain any bytes; those that are not UTF-8 are replaced.
  return SummaryJson(summary).dump(kIndent, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::map<std::string, TimeStatistics> SummarizeStages(const StageTimes& times) {
  std::map<std::string, TimeStatistics> stages;
  for (const auto& [stage, samples] : times.samples()) {
    stages[stage] = Summarize(times, stage);
  }
  return stages;
}

double PeakMemoryMb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;  // Linux counts in KiB
}

}  // namespace hullslam
