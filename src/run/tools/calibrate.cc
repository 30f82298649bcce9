// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration_text.h"
#include "files/staged_file.h"
#include "run/calibration_run.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/program.h"
#include "run/tools/commands.h"
#include "run/vocabularies.h"
#include "settings/camera_file.h"

namespace hullslam {
namespace {

struct CalibrateArguments {
  CalibrationRun run;
  std::filesystem::path output = "camera.yaml";
  std::string format = "hullslam";
  bool is_check = false;
};

void AddArguments(CLI::App& app, CalibrateArguments& arguments) {
  CalibrationRun& run = arguments.run;
  const DatasetHelp help = HelpOfAnyDataset();
  app.add_option("SEQUENCE", run.sequences, help.sequence + "; several are of one camera")
      ->required();
  AddAnyDatasetOptions(app, run.any);
  AddSettingsArgument(app, help.settings, run.settings);
  AddOverrides(app, run.overrides);
  AddVocabularyArgument(app, run.vocabulary);
  AddSelection(app, run.selection);
  app.add_flag("--from-nothing", run.is_unknown,
               "only the size of the images is known: the focal length of the settings and the "
               "lens are not used");
  app.add_option("--output", arguments.output, "file that is written")
      ->type_name("FILE")
      ->capture_default_str();
  app.add_flag(
      "--check", arguments.is_check,
      "only say what the recording tells about the camera, in one run; no file is written");
  app.add_option("--to", arguments.format, "format of the file")
      ->check(CLI::IsMember(CameraFormatNames()))
      ->capture_default_str();
  app.add_option(
         "--passes", run.max_passes,
         "number of runs at most, twice as many from nothing; each has the camera that the one "
         "before found")
      ->check(WholeNumber(1))
      ->capture_default_str();
  AddDebugFlag(app);
  app.add_flag("--quiet", run.is_quiet, "do not show the progress");
  AddVersionAndExitCodes(app, "done, also if nothing could be calibrated",
                         "the program was interrupted");
}

}  // namespace

int RunCalibrate(int argc, char** argv) {
  CLI::App app(
      "Calibrates a camera from recordings of anything, without a target: focal length, principal\n"
      "point, lens, rolling shutter, the disparities of depth images, and how the right camera of "
      "a\n"
      "pair is turned. Says what the recordings do not determine, and which motion would.",
      argv[0]);
  CalibrateArguments arguments;
  AddArguments(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  if (arguments.is_check) {
    arguments.run.max_passes = 1;
  } else {
    ProbeFile(arguments.output);
  }
  CatchInterrupts();
  const std::optional<CalibratedRun> calibrated = RunCalibration(arguments.run);
  if (!calibrated) {
    return kFailed;
  }
  Print("{}",
        CalibrationText(calibrated->calibration, calibrated->pair, calibrated->sequences.size()));
  if (arguments.is_check) {
    return kDone;
  }
  const auto names = CameraFormatNames();
  const auto format = std::ranges::find(names, arguments.format) - names.begin();
  const SystemOptions& options = calibrated->options;
  std::vector<NamedSetting> extra = ImageTimeSettings(options);
  const auto& cameras = calibrated->cameras;
  if (cameras) {
    std::ranges::copy(RightCameraSettings(*cameras), std::back_inserter(extra));
  }
  WriteFileAtomically(
      arguments.output,
      CameraFileText(static_cast<CameraFormat>(format), cameras ? cameras->left : options.camera,
                     options.frames_per_second, extra,
                     OriginOf(calibrated->calibration, calibrated->pair, calibrated->sequences)));
  Print("{} has the {}\n", arguments.output.string(),
        !cameras      ? "camera"
        : format == 0 ? "cameras of the pair"
                      : "left camera; only --to hullslam writes the right one");
  return kDone;
}

}  // namespace hullslam
