// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibration_text.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

#include "util/text.h"

namespace hullslam {
namespace {

std::string NumberWithUnit(const ParameterEvidence& one, double value) {
  return one.parameter.unit == "s"     ? fmt::format("{:.2f} ms", 1e3 * value)
         : one.parameter.unit == "m"   ? fmt::format("{:.2f} mm", 1e3 * value)
         : one.parameter.unit == "rad" ? fmt::format("{:.3f} deg", value * 180.0 / std::numbers::pi)
         : one.parameter.unit.empty()  ? fmt::format("{:.5f}", value)
                                       : fmt::format("{:.2f} {}", value, one.parameter.unit);
}

// A row of the table of a pair's numbers.
struct PairRow {
  std::string name;
  std::string value;
  std::string sigma;
  bool is_determined = false;
  bool is_changed = false;
  bool agrees = false;
};

std::vector<PairRow> RowsOf(const PairCalibration& pair) {
  std::vector<PairRow> rows;
  const auto add = [&](const char* name, const PairEvidence& one, bool is_angle, bool is_changed) {
    const auto text = [&](double value) {
      return is_angle ? fmt::format("{:.3f} deg", value * 180.0 / std::numbers::pi)
                      : fmt::format("{:.2f} px", value);
    };
    rows.push_back({name, text(one.value), text(one.sigma), one.is_determined,
                    is_changed && one.is_determined, std::abs(one.value) <= 2.0 * one.sigma});
  };
  const bool is_changed = pair.rows.is_changed;
  add("pitch", pair.rows.Of(PairNumber::kPitch), true, is_changed);
  add("roll", pair.rows.Of(PairNumber::kRoll), true, is_changed);
  add("yaw", pair.yaw, true, pair.deviation.turn.y() != 0.0);
  add("row_offset", pair.rows.Of(PairNumber::kRowOffset), false, is_changed);
  add("baseline_down", pair.rows.Of(PairNumber::kDown), true, is_changed);
  add("baseline_ahead", pair.rows.Of(PairNumber::kAhead), true, is_changed);
  return rows;
}

void AddPair(const PairCalibration& pair, std::string& text) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "the right camera, against the left one, from the rows of {} points:\n",
                 pair.rows.matches);
  bool is_all = true;
  for (const PairRow& row : RowsOf(pair)) {
    fmt::format_to(out, "{:<17} {:>12} {:>12} {:>11}  {}\n", row.name, "0",
                   row.is_determined ? row.value : "-", row.sigma,
                   row.is_changed       ? ""
                   : !row.is_determined ? "not determined, so it is kept"
                   : row.agrees         ? "agrees, so it is kept"
                                        : "too small to matter, so it is kept");
    is_all = is_all && row.is_determined;
  }
  fmt::format_to(out, "{:<17} {:>12} {:>12} {:>11}  no images tell its length; measure it\n",
                 "baseline", fmt::format("{:.4f} m", pair.given.bf / pair.given.fx), "-", "");
  fmt::format_to(out, "rows: median error {:.2f} -> {:.2f} px\n", pair.rows.median_before,
                 pair.is_changed ? pair.rows.median : pair.rows.median_before);
  if (!is_all) {
    fmt::format_to(
        out,
        "to know more about the pair: let things near and far reach all parts of the images, and "
        "move sideways\n");
  }
}

}  // namespace

std::string CalibrationText(const RecordedCalibration& calibration,
                            const std::optional<PairCalibration>& pair, size_t recordings) {
  const CameraCalibrationResult& result = calibration.result;
  const CalibrationProblem& problem = calibration.problem;
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{} of {}, {} points, {} observations, {}\n",
                 Counted(problem.views.size(), "image"), Counted(recordings, "recording"),
                 problem.points.size(), problem.CountObservations(),
                 calibration.passes == 1 ? "1 pass" : fmt::format("{} passes", calibration.passes));
  fmt::format_to(out, "{:<17} {:>12} {:>12} {:>11}  {}\n", "", "before", "calibrated", "sigma", "");
  std::set<std::string> advice;
  const MotionSummary motion = SummarizeMotion(problem);
  for (const ParameterEvidence& one : result.evidence.parameters) {
    const std::string& name = one.parameter.name;
    const bool is_calibrated = result.IsCalibrated(name);
    fmt::format_to(out, "{:<17} {:>12} {:>12} {:>11}  {}\n", name,
                   NumberWithUnit(one, one.parameter.ValueIn(result.given)),
                   is_calibrated ? NumberWithUnit(one, one.parameter.ValueIn(result.model)) : "-",
                   NumberWithUnit(one, one.sigma),
                   is_calibrated
                       ? (std::abs(one.correlation) > 0.9
                              ? fmt::format("goes with {} ({:.2f})", one.partner, one.correlation)
                              : "")
                   : one.parameter.kind == CameraParameter::Kind::kFocalLength && one.IsDetermined()
                       ? "kept: right within the scale of depth"
                       : "not determined, so it is kept");
    if (!is_calibrated && !one.IsDetermined()) {
      advice.insert(AdviceFor(one, motion));
    }
  }
  if (result.evidence.distortion_sigma >= 0.0) {
    fmt::format_to(out, "the lens as a whole: sigma {:.2f} px near a corner of the image\n",
                   result.evidence.distortion_sigma);
  }
  fmt::format_to(
      out,
      "median error {:.3f} -> {:.3f} px; sigmas are {:.1f} times those of a bundle adjustment\n",
      result.median_error_before, result.median_error, result.evidence.jackknife_factor);
  for (const std::string& one : advice) {
    fmt::format_to(out, "to know more: {}\n", one);
  }
  if (pair) {
    AddPair(*pair, text);
  }
  if (!result.is_changed && (!pair || !pair->is_changed)) {
    fmt::format_to(out, "the camera agrees with the {}; nothing was changed\n",
                   recordings > 1 ? "recordings" : "recording");
  }
  return text;
}

std::vector<std::string> OriginOf(const RecordedCalibration& calibration,
                                  const std::optional<PairCalibration>& pair,
                                  std::span<const std::string> recordings) {
  const CameraCalibrationResult& result = calibration.result;
  std::vector<std::string> lines = {"Calibrated by `hullslam calibrate` from"};
  for (const std::string& sequence : recordings) {
    lines.push_back("  " + sequence);
  }
  for (const ParameterEvidence& one : result.evidence.parameters) {
    lines.push_back(
        result.IsCalibrated(one.parameter.name)
            ? fmt::format("{}: sigma {}", one.parameter.name, NumberWithUnit(one, one.sigma))
            : one.parameter.name + ": as it was given");
  }
  if (pair) {
    for (const PairRow& row : RowsOf(*pair)) {
      lines.push_back(row.is_changed ? fmt::format("{} of the right camera: {}, sigma {}", row.name,
                                                   row.value, row.sigma)
                                     : row.name + " of the right camera: as it was given");
    }
  }
  return lines;
}

}  // namespace hullslam
