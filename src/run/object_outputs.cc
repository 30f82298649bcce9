// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/object_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "eval/object_metrics.h"
#include "util/counted.h"

namespace hullslam {
namespace {

// With a zero for each kind of change that did not happen.
std::map<std::string, size_t> CountChanges(const std::vector<ChangedObject>& changes) {
  std::map<std::string, size_t> counts;
  for (const ObjectChange change : kObjectChanges) {
    counts[std::string(ToString(change))] = static_cast<size_t>(
        std::count_if(changes.begin(), changes.end(),
                      [&](const ChangedObject& changed) { return changed.change == change; }));
  }
  return counts;
}

std::string At(const Eigen::Vector3d& position) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", position.x(), position.y(), position.z());
}

std::string Describe(const ChangedObject& changed) {
  const auto position = [](const std::optional<LocatedObject>& object) {
    return At(object->ellipsoid.world_from_object.translation);
  };
  switch (changed.change) {
    case ObjectChange::kMoved:
      return fmt::format("  moved: {} (object {}) from {} to {}, object {} now\n", changed.label,
                         changed.former->object.value, position(changed.former),
                         position(changed.now), changed.now->object.value);
    case ObjectChange::kGone:
      return fmt::format("  gone:  {} (object {}) from {}\n", changed.label,
                         changed.former->object.value, position(changed.former));
    case ObjectChange::kNew:
      return fmt::format("  new:   {} (object {}) at {}\n", changed.label,
                         changed.now->object.value, position(changed.now));
    default:
      return {};
  }
}

}  // namespace

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
  if (report.changes) {
    summary.changes = CountChanges(*report.changes);
  }
  return summary;
}

std::string FormatFigure(const std::optional<double>& figure, int decimals) {
  return figure ? fmt::format("{:.{}f}", *figure, decimals) : std::string("-");
}

std::string DescribeChanges(const std::vector<ChangedObject>& changes) {
  const std::map<std::string, size_t> counts = CountChanges(changes);
  std::string text = fmt::format(
      "objects of the map: {} seen again, {} moved, {} gone, {} not in view; {} new, {} at places "
      "that were not seen before\n",
      counts.at("seen_again"), counts.at("moved"), counts.at("gone"), counts.at("not_seen"),
      counts.at("new"), counts.at("first_seen"));
  for (const ChangedObject& changed : changes) {
    text += Describe(changed);
  }
  return text;
}

std::string DescribeObjects(const ObjectsSummary& summary, const char* unit) {
  return fmt::format(
      "{}, {} not mapped; means: SIoU {} with hulls, {} with masks, tangent distance {} "
      "px, MTD {} {}^2 (of {})",
      Counted(summary.count, "object"), summary.candidates, FormatFigure(summary.siou_mean, 3),
      FormatFigure(summary.siou_mask_mean, 3), FormatFigure(summary.tangent_mean_px, 1),
      FormatFigure(summary.mtd_mean_m2, 5), unit, Counted(summary.observations, "observation"));
}

}  // namespace hullslam
