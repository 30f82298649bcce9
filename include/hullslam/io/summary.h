// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "hullslam/util/stage_timer.h"

namespace hullslam {

// What a run reports, field by field as in `summary.json` (docs/outputs.md). What is not known, an
// error without ground truth say, is absent here and null in the file.
struct TrajectorySummary {
  std::optional<double> ate_rmse_m = std::nullopt;
  std::string alignment = "se3";  // none, se3 or sim3
  std::optional<double> scale = std::nullopt;
  size_t pairs = 0;                                 // of estimated and true poses
  size_t frames = 0;                                // that the run was given
  size_t tracked = 0;                               // with a pose
  size_t lost = 0;                                  // decoded, but without a pose
  std::string poses = "all frames";                 // which the errors are of, or "keyframes"
  std::string pairing = "tum";                      // the rule of the pairs, tum or evo
  std::optional<double> coverage = std::nullopt;    // share of the poses that have a pair
  std::optional<double> rpe_rmse_m = std::nullopt;  // over one second
  std::optional<double> rpe_rmse_deg = std::nullopt;
  size_t skipped = 0;   // frames with a broken image
  size_t unpaired = 0;  // colour images without depth
};

// Of the mapped objects, means over each one's observations and then over the objects.
struct ObjectsSummary {
  size_t count = 0;                                     // mapped
  std::optional<double> siou_mean = std::nullopt;       // with the hull
  std::optional<double> siou_mask_mean = std::nullopt;  // with the raw mask
  std::optional<double> mtd_mean_m2 = std::nullopt;
  std::optional<double> tangent_mean_px = std::nullopt;
  size_t observations = 0;  // of mapped objects in keyframes
  size_t candidates = 0;    // objects that were never, or are no longer, mapped
  size_t detections = 0;    // in all frames, as far as they were fit for use
  size_t frames_with_masks = 0;
  size_t frames_without_masks = 0;                // for which there was no file, or an empty one
  std::map<std::string, size_t> rejections = {};  // how often, by reason
};

struct TimingSummary {
  TimeStatistics track_ms;
  std::map<std::string, TimeStatistics> stages_ms;
  double total_s = 0.0;
  double frames_per_second = 0.0;
};

struct MapSummary {
  size_t keyframes = 0;
  size_t landmarks = 0;
  size_t loops = 0;
};

struct ProvenanceSummary {
  std::optional<std::string> version = std::nullopt;
  std::optional<std::string> git = std::nullopt;
  std::optional<std::string> settings_hash = std::nullopt;
  std::optional<std::string> preset = std::nullopt;
  uint64_t seed = 0;
  std::string pipeline = "sequential";  // or "threaded"
  std::optional<std::string> masks_format = std::nullopt;
  std::optional<std::string> sequence = std::nullopt;
};

struct RunSummary {
  TrajectorySummary trajectory;
  std::optional<ObjectsSummary> objects = std::nullopt;  // absent for a run without masks
  TimingSummary timing;
  double peak_memory_mb = 0.0;
  MapSummary map;
  ProvenanceSummary provenance;
};

// JSON with the keys in the order of the structs, ended by a line feed.
std::string FormatSummary(const RunSummary& summary);

// Writes FormatSummary() by WriteFileAtomically().
void WriteSummary(const std::filesystem::path& path, const RunSummary& summary);

// The statistics of each stage.
std::map<std::string, TimeStatistics> SummarizeStages(const StageTimes& times);

// Largest resident memory of this process up to now, MB (10^6 bytes).
double PeakMemoryMb();

}  // namespace hullslam
