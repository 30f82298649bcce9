// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/object_outputs.h"

#include <fmt/format.h>

#include "hullslam/eval/object_metrics.h"
#include "hullslam/io/object_file.h"
#include "hullslam/io/ply_file.h"

namespace hullslam {

ObjectReport CollectObjects(const Map& map, const PinholeCamera& camera,
                            const std::filesystem::path& sequence) {
  ObjectReport report = ReportObjects(map, camera);
  report.sequence = sequence.string();
  MeasureObjects(report);
  return report;
}

ObjectsSummary SummarizeObjects(const ObjectReport& report, const ObjectCounts& counts) {
  const MapFit fit = SummarizeFits(report);
  ObjectsSummary summary;
  summary.count = fit.objects;
  summary.siou_mean = fit.mean.siou;
  summary.siou_mask_mean = fit.mean.siou_mask;
  summary.mtd_mean_m2 = fit.mean.mtd_m2;
  summary.tangent_mean_px = fit.mean.tangent_px;
  summary.observations = fit.mean.observations;
  summary.candidates = report.candidates;
  summary.detections = counts.detections;
  summary.frames_with_masks = counts.frames_with_masks;
  summary.frames_without_masks = counts.frames_without_masks;
  summary.rejections = counts.rejections;
  return summary;
}

std::vector<FileContent> ObjectFiles(const ObjectReport& report) {
  return {{"objects.json", FormatObjects(report)},
          {"objects_observations.json", FormatObservations(report)},
          {"objects.csv", FormatObjectsCsv(report)},
          {"objects.ply", FormatObjectsPly(report.objects)}};
}

std::string FormatFigure(const std::optional<double>& figure, int decimals) {
  return figure ? fmt::format("{:.{}f}", *figure, decimals) : std::string("-");
}

std::string DescribeObjects(const ObjectsSummary& summary) {
  return fmt::format(
      "{} objects, {} candidates; means: SIoU {} with hulls, {} with masks, tangent distance {} "
      "px, "
      "MTD {} m^2 (of {} observations)",
      summary.count, summary.candidates, FormatFigure(summary.siou_mean, 3),
      FormatFigure(summary.siou_mask_mean, 3), FormatFigure(summary.tangent_mean_px, 1),
      FormatFigure(summary.mtd_mean_m2, 5), summary.observations);
}

}  // namespace hullslam
