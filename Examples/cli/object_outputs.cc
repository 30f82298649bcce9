// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/object_outputs.h"

#include "hullslam/eval/object_metrics.h"

namespace hullslam {

ObjectReport MeasuredReport(const Map& map, const PinholeCamera& camera,
                            const std::string& sequence) {
  ObjectReport report = ReportObjects(map, camera);
  report.sequence = sequence;
  MeasureObjects(report);
  return report;
}

ObjectsSummary SummarizeObjects(const ObjectReport& report) {
  const MapFit fit = SummarizeFits(report);
  ObjectsSummary summary;
  summary.count = fit.objects;
  summary.siou_mean = fit.mean.siou;
  summary.siou_mask_mean = fit.mean.siou_mask;
  summary.mtd_mean_m2 = fit.mean.mtd_m2;
  summary.tangent_mean_px = fit.mean.tangent_px;
  summary.observations = fit.mean.observations;
  summary.candidates = report.candidates;
  return summary;
}

}  // namespace hullslam
