// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/slam_program.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/calibration_text.h"
#include "hullslam/util/error.h"
#include "run/calibration_run.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/program.h"
#include "run/slam_run.h"
#include "run/tools/commands.h"
#include "run/view_arguments.h"

namespace hullslam {
namespace {

// Parses the command line, in which --view may have no value. Returns false as ParseCommandLine()
// does.
bool Parse(CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words = CompleteViewOption(argc, argv);
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  return ParseCommandLine(app, argc, pointers.data());
}

// Calibrates the camera on the images of the run, and adds its numbers to the settings: those of
// --set that the user gives come after them. False if it is interrupted.
bool SelfCalibrate(const Dataset& dataset, RunArguments& arguments, DatasetChoices& choices) {
  constexpr size_t kFrames = 1200;
  const bool is_unknown = arguments.settings.empty();
  if (is_unknown) {
    ChooseAnyFieldOfView(dataset, choices);
  }
  const std::optional<CalibratedRun> calibrated =
      RunCalibration({.sequences = {arguments.sequence},
                      .any = {.sensor = arguments.sensor, .choices = choices},
                      .settings = arguments.settings,
                      .overrides = arguments.overrides,
                      .vocabulary = arguments.vocabulary,
                      .selection = arguments.selection,
                      .is_unknown = is_unknown,
                      .max_frames = kFrames,
                      .is_quiet = arguments.quiet});
  if (!calibrated) {
    return false;
  }
  if (!arguments.quiet) {
    Print("{}",
          CalibrationText(calibrated->calibration, calibrated->pair, calibrated->sequences.size()));
  }
  if (calibrated->pair && calibrated->pair->is_changed) {
    throw InputError(
        "the right camera is turned against the left one, which --self-calibrate cannot use: "
        "expected "
        "`hullslam calibrate SEQUENCE --output camera.yaml`, then --settings camera.yaml");
  }
  std::vector<std::string> overrides = OverridesOf(calibrated->options);
  overrides.insert(overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
  arguments.overrides = std::move(overrides);
  return true;
}

int RunOnDataset(const Dataset& dataset, RunArguments arguments, DatasetChoices choices) {
  if (arguments.self_calibrate) {
    CatchInterrupts();
    if (!SelfCalibrate(dataset, arguments, choices)) {
      return kFailed;
    }
  }
  OpenedDataset opened = OpenDatasetLoudly(dataset, {.path = arguments.sequence,
                                                     .sensor = arguments.sensor,
                                                     .settings = arguments.settings,
                                                     .preset = arguments.preset,
                                                     .overrides = arguments.overrides,
                                                     .associations = arguments.associations,
                                                     .groundtruth = arguments.groundtruth,
                                                     .selection = arguments.selection,
                                                     .choices = choices});
  if (arguments.groundtruth == "none" ||
      (!arguments.groundtruth.empty() && !dataset.reads_groundtruth)) {
    UseGivenGroundtruth(arguments.groundtruth, dataset.expected_stamps, opened.sequence);
  }
  ReadOdometry(arguments.odometry, arguments.sensor, opened.sequence);
  PrintWarnings(opened.sequence.warnings);
  return RunSlam(arguments, std::move(opened.settings), opened.sequence, opened.notes);
}

int Run(const SlamProgram& program, int argc, char** argv) {
  const Dataset& dataset = DatasetOfProgram(program.dataset, program.sensor);
  RunArguments arguments;
  arguments.sensor = program.sensor;
  arguments.program = ProgramOf(dataset, program.sensor);
  CLI::App app(program.description, arguments.program);
  std::vector<std::string> positional;
  DatasetChoices choices;
  AddRunArguments(app, dataset.help(program.sensor), arguments, positional);
  AddDatasetOptions(app, dataset.options, choices);
  if (!Parse(app, argc, argv)) {
    return kDone;
  }
  FinishArguments(positional, arguments);
  return RunOnDataset(dataset, arguments, choices);
}

}  // namespace

int RunSlamProgram(const SlamProgram& program, int argc, char** argv) {
  return RunMain([&](int count, char** words) { return Run(program, count, words); }, argc, argv);
}

int RunRun(int argc, char** argv) {
  CLI::App app("Runs SLAM on a sequence of any kind, which is found by its files.", argv[0]);
  RunArguments arguments;
  AnyDatasetArguments any;
  AddAnyRunArguments(app, HelpOfAnyDataset(), arguments);
  AddAnyDatasetOptions(app, any);
  if (!Parse(app, argc, argv)) {
    return kDone;
  }
  const FoundDataset found =
      FindDataset(arguments.sequence, any.sensor, any.choices, arguments.associations);
  arguments.sensor = found.sensor;
  arguments.program = ProgramOf(*found.dataset, found.sensor);
  CheckSensorOptions(arguments);
  if (!arguments.quiet) {
    Print("{}\n", found.note);
  }
  return RunOnDataset(*found.dataset, arguments, any.choices);
}

}  // namespace hullslam
