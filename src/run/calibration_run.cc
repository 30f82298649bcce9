// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/calibration_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "calibration/guess_camera.h"
#include "calibration/recorded_camera.h"
#include "hullslam/util/error.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/vocabularies.h"
#include "system/make_sensor.h"
#include "util/text.h"

namespace hullslam {
namespace {

// Opens the recordings. Of a video without settings, only the size of its images is used.
std::vector<OpenedDataset> OpenAll(const CalibrationRun& run) {
  std::vector<OpenedDataset> opened;
  for (const std::filesystem::path& sequence : run.sequences) {
    AnyDatasetArguments any = run.any;
    const FoundDataset found = FindDataset(sequence, any.sensor, any.choices);
    if (run.is_unknown && run.settings.empty()) {
      ChooseAnyFieldOfView(*found.dataset, any.choices);
    }
    opened.push_back(OpenAnyDataset(any, {.path = sequence,
                                          .settings = run.settings,
                                          .overrides = run.overrides,
                                          .selection = run.selection,
                                          .need_rows = run.is_unknown}));
    const PinholeCamera& camera = opened.back().settings.options.camera;
    const PinholeCamera& first = opened.front().settings.options.camera;
    if (camera.width != first.width || camera.height != first.height) {
      throw InputError(
          fmt::format("{}: has images of {}x{} px, expected those of {}, {}x{} px: "
                      "the recordings must be of one camera",
                      sequence.string(), camera.width, camera.height,
                      run.sequences.front().string(), first.width, first.height));
    }
  }
  return opened;
}

// `opened` must outlive them.
std::vector<CameraRecording> RecordingsOf(const CalibrationRun& run,
                                          const std::vector<OpenedDataset>& opened) {
  std::vector<CameraRecording> recordings;
  for (const OpenedDataset& one : opened) {
    const ImageSequence& sequence = one.sequence;
    const size_t frames = std::min(run.max_frames, sequence.frames.size());
    recordings.push_back({frames, [&sequence](size_t frame, const auto& camera) {
                            return sequence.load(sequence.frames[frame], camera);
                          }});
  }
  return recordings;
}

std::string NumberWithUnit(const ParameterEvidence& one, double value) {
  return one.parameter.unit == "s"     ? fmt::format("{:.2f} ms", 1e3 * value)
         : one.parameter.unit == "m"   ? fmt::format("{:.2f} mm", 1e3 * value)
         : one.parameter.unit == "rad" ? fmt::format("{:.3f} deg", 180.0 / 3.14159265 * value)
         : one.parameter.unit.empty()  ? fmt::format("{:.5f}", value)
                                       : fmt::format("{:.2f} {}", value, one.parameter.unit);
}

// The rectifier that has made the images of a pair.
StereoRectifier RectifierOf(const ImageSequence& sequence, const PinholeCamera& camera) {
  const auto warp = std::ranges::find_if(
      sequence.warps, [](const ImageWarp& one) { return one.rectifier != nullptr; });
  return warp != sequence.warps.end() ? *warp->rectifier
                                      : StereoRectifier(RectifiedPair(camera), "the pair");
}

// The calibrated cameras as read; absent if both are rectified, so that one camera describes them.
std::optional<StereoCalibration> CamerasOf(const PairCalibration& pair,
                                           const ImageSequence& sequence) {
  const StereoRectifier rectifier = RectifierOf(sequence, pair.given);
  return pair.is_changed || !rectifier.IsIdentity() ? std::optional(pair.Cameras(rectifier))
                                                    : std::nullopt;
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

void PrintPair(const PairCalibration& pair) {
  Print("the right camera, against the left one, from the rows of {} points:\n", pair.rows.matches);
  bool is_all = true;
  for (const PairRow& row : RowsOf(pair)) {
    Print("{:<17} {:>12} {:>12} {:>11}  {}\n", row.name, "0", row.is_determined ? row.value : "-",
          row.sigma,
          row.is_changed       ? ""
          : !row.is_determined ? "not determined, so it is kept"
          : row.agrees         ? "agrees, so it is kept"
                               : "too small to matter, so it is kept");
    is_all = is_all && row.is_determined;
  }
  Print("{:<17} {:>12} {:>12} {:>11}  no images tell its length; measure it\n", "baseline",
        fmt::format("{:.4f} m", pair.given.bf / pair.given.fx), "-", "");
  Print("rows: median error {:.2f} -> {:.2f} px\n", pair.rows.median_before,
        pair.is_changed ? pair.rows.median : pair.rows.median_before);
  if (!is_all) {
    Print(
        "to know more about the pair: let things near and far reach all parts of the images, and "
        "move sideways\n");
  }
}

}  // namespace

void ChooseAnyFieldOfView(const Dataset& dataset, DatasetChoices& choices) {
  constexpr const char* kKey = "fov";
  if (std::ranges::any_of(dataset.options, [](const DatasetOption& option) {
        return std::string_view(option.key) == kKey;
      })) {
    choices.try_emplace(kKey, "65");
  }
}

std::optional<CalibratedRun> RunCalibration(const CalibrationRun& run) {
  const std::vector<OpenedDataset> opened = OpenAll(run);
  SystemOptions options = opened.front().settings.options;
  options.vocabulary = ChooseVocabulary(run.vocabulary, run.is_quiet);
  const std::vector<CameraRecording> recordings = RecordingsOf(run, opened);
  const bool is_pair = MakeSensor(options).IsStereo();
  std::unique_ptr<Progress> progress;
  RecordedCalibrationOptions calibration{
      .camera = {}, .max_passes = run.max_passes, .cancellation = &Interruption()};
  // The images of a pair are rectified, so they have no distortion.
  calibration.camera.choice.distortion = !is_pair;
  calibration.camera.choice.disparity = options.sensor == SensorKind::kRgbd;
  calibration.on_frame = [&](int pass, size_t frame, size_t frames) {
    if (!progress || frame == 1) {
      if (progress) {
        progress->Clear();
      }
      progress = std::make_unique<Progress>(frames, run.is_quiet);
    }
    progress->Show(frame, [pass] {
      return pass == 0 ? std::string("looking for the focal length") : fmt::format("pass {}", pass);
    });
  };
  if (run.is_unknown) {
    // A guess needs more runs than a camera that is nearly right.
    calibration.max_passes *= 2;
    options.camera = GuessCamera(options, recordings.front(), calibration);
    options.readout_time = 0.0;
    calibration.camera.guess = ModelOf(MakeSensor(options), options.depth);
  } else {
    calibration.camera.trusted_focal_length = options.camera.fx;
  }
  CalibratedRun calibrated;
  if (is_pair && !run.is_unknown) {
    calibrated.pair = CalibratePair(options, recordings, calibration);
    calibrated.calibration = calibrated.pair->recorded;
  } else {
    calibrated.calibration = CalibrateFromRecordings(options, recordings, calibration);
  }
  if (progress) {
    progress->Clear();
  }
  if (IsInterrupted()) {
    PrintFailure("the program was interrupted; nothing was written");
    return std::nullopt;
  }
  calibrated.options = std::move(options);
  ApplyModel(calibrated.calibration.result.model, calibrated.options);
  if (calibrated.pair) {
    calibrated.cameras = CamerasOf(*calibrated.pair, opened.front().sequence);
  }
  for (const std::filesystem::path& sequence : run.sequences) {
    calibrated.sequences.push_back(sequence.string());
  }
  return calibrated;
}

void PrintCalibration(const CalibratedRun& calibrated) {
  const CameraCalibrationResult& result = calibrated.calibration.result;
  const CalibrationProblem& problem = calibrated.calibration.problem;
  Print("{} of {}, {} points, {} observations, {}\n", Counted(problem.views.size(), "image"),
        Counted(calibrated.sequences.size(), "recording"), problem.points.size(),
        problem.CountObservations(),
        calibrated.calibration.passes == 1
            ? "1 pass"
            : fmt::format("{} passes", calibrated.calibration.passes));
  Print("{:<17} {:>12} {:>12} {:>11}  {}\n", "", "before", "calibrated", "sigma", "");
  std::set<std::string> advice;
  const MotionSummary motion = SummarizeMotion(problem);
  for (const ParameterEvidence& one : result.evidence.parameters) {
    const std::string& name = one.parameter.name;
    const bool is_calibrated = result.IsCalibrated(name);
    Print("{:<17} {:>12} {:>12} {:>11}  {}\n", name,
          NumberWithUnit(one, one.parameter.ValueIn(result.given)),
          is_calibrated ? NumberWithUnit(one, one.parameter.ValueIn(result.model)) : "-",
          NumberWithUnit(one, one.sigma),
          is_calibrated ? (std::abs(one.correlation) > 0.9
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
    Print("the lens as a whole: sigma {:.2f} px near a corner of the image\n",
          result.evidence.distortion_sigma);
  }
  Print("median error {:.3f} -> {:.3f} px; sigmas are {:.1f} times those of a bundle adjustment\n",
        result.median_error_before, result.median_error, result.evidence.jackknife_factor);
  for (const std::string& one : advice) {
    Print("to know more: {}\n", one);
  }
  if (calibrated.pair) {
    PrintPair(*calibrated.pair);
  }
  if (!result.is_changed && !(calibrated.pair && calibrated.pair->is_changed)) {
    Print("the camera agrees with the {}; nothing was changed\n",
          calibrated.sequences.size() > 1 ? "recordings" : "recording");
  }
}

std::vector<std::string> OriginOf(const CalibratedRun& calibrated) {
  const CameraCalibrationResult& result = calibrated.calibration.result;
  std::vector<std::string> lines = {"Calibrated by `hullslam calibrate` from"};
  for (const std::string& sequence : calibrated.sequences) {
    lines.push_back("  " + sequence);
  }
  for (const ParameterEvidence& one : result.evidence.parameters) {
    lines.push_back(
        result.IsCalibrated(one.parameter.name)
            ? fmt::format("{}: sigma {}", one.parameter.name, NumberWithUnit(one, one.sigma))
            : one.parameter.name + ": as it was given");
  }
  if (calibrated.pair) {
    for (const PairRow& row : RowsOf(*calibrated.pair)) {
      lines.push_back(row.is_changed ? fmt::format("{} of the right camera: {}, sigma {}", row.name,
                                                   row.value, row.sigma)
                                     : row.name + " of the right camera: as it was given");
    }
  }
  return lines;
}

std::vector<NamedSetting> ImageTimeSettings(const SystemOptions& options) {
  const DepthOptions& depth = options.depth;
  std::vector<NamedSetting> settings = {
      {"Camera.readout_time", fmt::format("{}", options.readout_time)},
      {"depth.disparity_offset", fmt::format("{}", depth.disparity_offset)},
      {"depth.time_offset", fmt::format("{}", depth.time_offset)}};
  for (size_t i = 0; i < depth.pose.size(); ++i) {
    settings.push_back({fmt::format("depth.{}_{}", i < 3 ? "turn" : "shift", "xyz"[i % 3]),
                        fmt::format("{}", depth.pose.at(i))});
  }
  return settings;
}

std::vector<std::string> OverridesOf(const SystemOptions& options) {
  std::vector<std::string> overrides;
  for (const auto& settings : {CameraSettings(options.camera), ImageTimeSettings(options)}) {
    for (const auto& [key, value] : settings) {
      overrides.push_back(key + "=" + value);
    }
  }
  return overrides;
}

}  // namespace hullslam
