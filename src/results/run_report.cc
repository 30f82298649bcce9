// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "objects/resolved_observation.h"
#include "results/summarize_run.h"
#include "util/text.h"

namespace hullslam {
namespace {

// Of a camera that was lost and went on elsewhere; nothing if the map is in one piece.
std::string DescribeIslands(const IslandsSummary& islands, bool are_kept) {
  std::string text;
  if (islands.begun < 2) {
    return {};
  }
  const size_t left = islands.begun - islands.joined - 1;
  text +=
      fmt::format("the map was begun {} times; {} of its parts were joined, {} {}\n", islands.begun,
                  islands.joined, left, are_kept ? "written on their own" : "removed");
  for (const IslandSummary& island : islands.at_end) {
    if (!island.is_main && island.first_timestamp && island.last_timestamp) {
      text += fmt::format(
          "  part {}: {} from {:.3f} to {:.3f} s, {}{}\n", island.number,
          Counted(island.frames, "frame"), *island.first_timestamp, *island.last_timestamp,
          Counted(island.keyframes, "keyframe"),
          island.ate_rmse_m ? fmt::format(", ATE RMSE {:.4f} m", *island.ate_rmse_m) : "");
    }
  }
  return text;
}

// Where frames were lost, why, and what the user can try. Only the longest stretches are shown.
std::string DescribeLosses(std::span<const LostStretch> losses) {
  std::string text;
  constexpr size_t kMostShown = 5;
  std::vector<const LostStretch*> shown;
  for (const LostStretch& stretch : losses) {
    shown.push_back(&stretch);
  }
  std::stable_sort(shown.begin(), shown.end(), [](const LostStretch* a, const LostStretch* b) {
    return a->frames > b->frames;
  });
  shown.resize(std::min(shown.size(), kMostShown));
  std::sort(shown.begin(), shown.end());
  std::set<TrackingFailure> reasons;
  for (const LostStretch* stretch : shown) {
    text +=
        fmt::format("lost: frames {} to {} ({}; {:.3f} to {:.3f} s): {}\n", stretch->first_frame,
                    stretch->last_frame, stretch->frames, stretch->first_timestamp,
                    stretch->last_timestamp, ToString(stretch->reason));
    reasons.insert(stretch->reason);
  }
  if (losses.size() > shown.size()) {
    text += fmt::format("and {} shorter stretches (trajectory.losses in summary.json)\n",
                        losses.size() - shown.size());
  }
  for (const TrackingFailure reason : reasons) {
    text += fmt::format("  {}: {}\n", ToString(reason), AdviceFor(reason));
  }
  if (!shown.empty()) {
    text += "docs/my-run-fails.md has more about each reason\n";
  }
  return text;
}

// Where poses may be wrong although the camera was tracked. Only the longest stretch is named.
std::string DescribeUnsure(std::span<const FrameStretch> unsure) {
  if (unsure.empty()) {
    return {};
  }
  size_t frames = 0;
  for (const FrameStretch& stretch : unsure) {
    frames += stretch.frames;
  }
  const auto longest = std::max_element(
      unsure.begin(), unsure.end(),
      [](const FrameStretch& a, const FrameStretch& b) { return a.frames < b.frames; });
  return fmt::format(
      "warning: the poses of {} frames are unsure, most of them in a row from {:.3f} to {:.3f} s "
      "(frames {} to {}): they rest on landmarks that only two keyframes see, so the map may have "
      "another scale and direction from there on (trajectory.unsure in summary.json; "
      "docs/my-run-fails.md)\n",
      frames, longest->first_timestamp, longest->last_timestamp, longest->first_frame,
      longest->last_frame);
}

std::string DescribeMap(const MapSummary& map) {
  std::string text = fmt::format(
      "{}, {}{}{}\n", Counted(map.keyframes, "keyframe"), Counted(map.landmarks, "landmark"),
      map.landmarks_at_infinity > 0
          ? fmt::format(" ({} of them as good as infinitely far away)", map.landmarks_at_infinity)
          : "",
      map.reprojection_px
          ? fmt::format(", reprojection error {:.3f} px (median)", *map.reprojection_px)
          : "");
  if (map.contradicted_landmarks > 0) {
    text += fmt::format(
        "{} removed because later depth images show that nothing is there; if there are many, "
        "something without a mask has moved\n",
        Counted(map.contradicted_landmarks, "landmark"));
  }
  return text;
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

std::string DescribeRun(const RunSummary& summary, const ObjectResults& objects, SensorKind sensor,
                        bool keeps_islands) {
  std::string text;
  const TrajectorySummary& trajectory = summary.trajectory;
  text += fmt::format("{}: {} tracked, {} lost, {} skipped", Counted(trajectory.frames, "frame"),
                      trajectory.tracked, trajectory.lost, trajectory.skipped);
  if (!summary.initialisation) {  // with depth, or a loaded map
    const char* const lacking = sensor == SensorKind::kRgbd ? "depth" : "a partner";
    text += fmt::format("{}\n", sensor == SensorKind::kMonocular
                                    ? std::string()
                                    : fmt::format("; {} without {}",
                                                  Counted(trajectory.unpaired, "image"), lacking));
  } else if (summary.initialisation->seconds) {
    text += fmt::format("; first map after {:.2f} s\n", *summary.initialisation->seconds);
  } else {
    text += fmt::format("; no map\n");
  }
  text += DescribeIslands(summary.islands.value_or(IslandsSummary()), keeps_islands);
  text += DescribeLosses(trajectory.losses);
  text += DescribeUnsure(trajectory.unsure);
  if (trajectory.ate_rmse_m) {
    text += fmt::format(
        "ATE RMSE {:.4f} m ({} alignment, {} pairs of poses, coverage {:.1f} % of the sequence)\n",
        *trajectory.ate_rmse_m, trajectory.alignment, trajectory.pairs,
        100.0 * trajectory.coverage.value_or(0.0));
  }
  if (trajectory.rpe_rmse_m && trajectory.rpe_rmse_deg) {
    text += fmt::format("RPE RMSE {:.4f} m, {:.3f} degrees over 1 s\n", *trajectory.rpe_rmse_m,
                        *trajectory.rpe_rmse_deg);
  }
  text += DescribeMap(summary.map);
  if (summary.map.known_sizes) {
    text += fmt::format(
        "{}\n", *summary.map.known_sizes > 0
                    ? fmt::format("the unit of length is the metre (objects of known size: {})",
                                  *summary.map.known_sizes)
                    : "the unit of length is unknown: no object of a known size was mapped");
  }
  if (summary.objects) {
    const bool is_metric =
        trajectory.alignment != "sim3" || summary.map.known_sizes.value_or(0) > 0;
    text += fmt::format("{}\n", DescribeObjects(*summary.objects, is_metric ? "m" : "u"));
    if (objects.changes) {
      text += DescribeChanges(*objects.changes);
    }
  }
  text += fmt::format(
      "tracking {:.1f} ms per frame (median; mean {:.1f}, p95 {:.1f}); {:.1f} frames/s overall; "
      "peak memory {:.0f} MB\n",
      summary.timing.track_ms.median, summary.timing.track_ms.mean, summary.timing.track_ms.p95,
      summary.timing.frames_per_second, summary.peak_memory_mb);
  return text;
}

std::string DescribeState(TrackingState state, std::optional<InitialisationFailure> failure,
                          const Map* map) {
  if (failure) {
    return fmt::format("{}: {}", ToString(state), ToString(*failure));
  }
  std::string text = fmt::format("{}  {}  {}", ToString(state),
                                 Counted(map != nullptr ? map->keyframes().size() : 0, "keyframe"),
                                 Counted(map != nullptr ? map->landmarks().size() : 0, "landmark"));
  if (map != nullptr && map->islands_begun() > 1) {
    text += fmt::format("  {} parts of the map, {} joined", map->islands_begun(),
                        map->islands_joined());
  }
  return text;
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
      "{}, {} not mapped; means: SIoU {} with hulls, {} with masks, tangent distance {} px, MTD {} "
      "{}^2 (of {})",
      Counted(summary.count, "object"), summary.candidates, FormatFigure(summary.siou_mean, 3),
      FormatFigure(summary.siou_mask_mean, 3), FormatFigure(summary.tangent_mean_px, 1),
      FormatFigure(summary.mtd_mean_m2, 5), unit, Counted(summary.observations, "observation"));
}

std::string DescribeMapped(const Map& map, const ObjectResults& report) {
  std::string text =
      fmt::format("{:>4} {:<14} {:>5} {:>8} {:>20} {:>6} {:>6} {:>7}\n", "id", "class", "views",
                  "parallax", "half axes (m)", "SIoU", "mask", "misfit");
  for (const ObjectResult& object : report.objects) {
    if (object.state != ObjectState::kMapped) {
      continue;
    }
    const ObjectLandmark& landmark = map.objects().At(object.id);
    const double parallax = Parallax(ResolveObservations(map, landmark),
                                     object.ellipsoid.world_from_object.translation);
    const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
    text += fmt::format(
        "{:>4} {:<14} {:>5} {:>7.0f}° {:>6.3f} {:>6.3f} {:>6.3f} {:>6} {:>6} {:>5.1f}px{}\n",
        object.id.value, object.label, object.observations.size(), parallax, axes.x(), axes.y(),
        axes.z(), FormatFigure(object.fit.siou, 3), FormatFigure(object.fit.siou_mask, 3),
        object.misfit_px, object.NameAtEnd());
  }
  return text;
}

}  // namespace hullslam
