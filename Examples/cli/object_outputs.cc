// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/object_outputs.h"

#include <fmt/format.h>

#include "hullslam/eval/object_metrics.h"
#include "hullslam/io/map_file.h"
#include "hullslam/io/object_file.h"

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

std::vector<FileContent> ObjectFiles(const std::filesystem::path& folder,
                                     const ObjectReport& report) {
  return {{folder / "objects.json", FormatObjects(report)},
          {folder / "objects.ply", FormatObjectsPly(report.objects)}};
}

std::string DescribeObjects(const ObjectsSummary& summary) {
  return fmt::format(
      "{} objects, {} candidates; mean SIoU {:.3f} with hulls, {:.3f} with masks, tangents {:.1f} "
      "px "
      "off, MTD {:.2e} m^2 ({} observations)",
      summary.count, summary.candidates, summary.siou_mean.value_or(0.0),
      summary.siou_mask_mean.value_or(0.0), summary.tangent_mean_px.value_or(0.0),
      summary.mtd_mean_m2.value_or(0.0), summary.observations);
}

}  // namespace hullslam
