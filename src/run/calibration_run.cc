// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/calibration_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "calibration/guess_camera.h"
#include "hullslam/util/error.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/vocabularies.h"
#include "system/make_sensor.h"

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
