// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/slam_program.h"

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "run/command_line.h"
#include "run/datasets/given_groundtruth.h"
#include "run/input_warnings.h"
#include "run/live_output.h"
#include "run/program.h"
#include "run/slam_run.h"
#include "sequences/resized_images.h"

namespace hullslam {
namespace {

int Run(const SlamProgram& program, Dataset& dataset, int argc, char** argv) {
  CLI::App app(program.description, program.name);
  RunArguments arguments;
  arguments.sensor = program.sensor;
  arguments.program = program.name;
  std::vector<std::string> positional;
  AddRunArguments(app, dataset.Help(program.sensor), arguments, positional);
  dataset.AddOptions(app);
  std::vector<std::string> words = CompleteViewOption(argc, argv);
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  if (!ParseCommandLine(app, argc, pointers.data())) {
    return kDone;
  }
  FinishArguments(positional, arguments);
  DatasetInput input = dataset.Open(arguments);
  input.settings.options.sensor = program.sensor;
  if (arguments.groundtruth == "none" ||
      (!arguments.groundtruth.empty() && !dataset.ReadsGroundtruth())) {
    UseGivenGroundtruth(arguments.groundtruth, dataset.ExpectedStamps(), input.sequence);
  }
  if (input.settings.read_width > 0) {
    ResizeImages(input.settings.read_width, input.settings.read_height,
                 input.settings.options.camera, input.sequence);
    if (!arguments.quiet) {
      input.notes.push_back("images are resized from " + input.sequence.choices["resized_from"]);
    }
  }
  PrintWarnings(input.sequence);
  return RunSlam(arguments, std::move(input.settings), input.sequence, input.notes);
}

}  // namespace

int RunSlamProgram(const SlamProgram& program, std::unique_ptr<Dataset> dataset, int argc,
                   char** argv) {
  return RunMain([&](int count, char** words) { return Run(program, *dataset, count, words); },
                 argc, argv);
}

}  // namespace hullslam
