// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/icl_arguments.h"

#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <utility>

#include "cli/input_warnings.h"
#include "cli/messages.h"
#include "cli/program.h"
#include "cli/slam_run.h"
#include "hullslam/io/settings.h"

namespace hullslam {
namespace {

// Adds an option that is one of the names and sets the field to its value.
template <typename Enum>
void AddNamed(CLI::App& app, const std::string& option, const std::map<std::string, Enum>& values,
              Enum& field, const std::string& help) {
  app.add_option_function<std::string>(
         option, [&field, values](const std::string& name) { field = values.at(name); }, help)
      ->check(CLI::IsMember(values).description(""))
      ->type_name("NAME");
}

}  // namespace

DatasetHelp IclHelp() {
  return {.sequence = "folder of ICL-NUIM, of either package (--package)",
          .settings = "default: camera.yaml in SEQUENCE; without it, config/ICL.yaml",
          .associations =
              "index depth index rgb (default: associations.txt in SEQUENCE; package tum only)"};
}

void AddIclArguments(CLI::App& app, IclSequenceOptions& icl) {
  AddNamed<IclPackage>(
      app, "--package", {{"tum", IclPackage::kTum}, {"povray", IclPackage::kPovray}}, icl.package,
      "tum: rgb/N.png, depth/N.png and associations.txt; povray: scene_00_NNNN.png, .depth and "
      ".txt (default: by the files in SEQUENCE)");
  app.add_option("--groundtruth", icl.groundtruth,
                 "true trajectory in TUM's format, with indices of frames as time stamps (default: "
                 "the .txt files of package povray, else *.gt.freiburg or groundtruth.txt in "
                 "SEQUENCE)");
  AddNamed<CameraYAxis>(
      app, "--groundtruth-y", {{"up", CameraYAxis::kUp}, {"down", CameraYAxis::kDown}},
      icl.groundtruth_y,
      "where the y axis of the ground truth's cameras points; up (fy < 0) means that it is "
      "mirrored (default: what the depth images agree with; docs/datasets.md)");
  app.add_option("--povray-units", icl.povray_units,
                 "lengths in the .depth and .txt files per metre (100: centimetres)")
      ->check(CLI::Range(1e-6, 1e6).description(""))
      ->capture_default_str();
}

SystemOptions LoadIclOptions(const RunArguments& arguments) {
  std::error_code error;
  std::filesystem::path settings = arguments.settings;
  if (settings.empty()) {
    settings = arguments.sequence / "camera.yaml";
    if (!std::filesystem::exists(settings, error)) {
      settings = FindConfigFolder() / "ICL.yaml";
    }
  }
  SystemOptions options = LoadSettings(settings, arguments.overrides, NegativeFy::kPositive);
  options.sensor = arguments.sensor;
  return options;
}

ImageSequence OpenIcl(const RunArguments& arguments, IclSequenceOptions icl,
                      const SystemOptions& options) {
  icl.associations = arguments.associations;
  icl.use_depth = arguments.sensor == SensorKind::kRgbd;
  icl.selection = arguments.selection;
  IclSequence sequence = OpenIclSequence(arguments.sequence, options.camera, options.depth, icl);
  if (!arguments.quiet) {
    Print("ICL-NUIM, package {}\n", sequence.package == IclPackage::kTum ? "tum" : "povray");
    Print("ground truth: {}\n",
          sequence.groundtruth_note.empty() ? "none" : sequence.groundtruth_note);
  }
  return std::move(sequence.images);
}

int RunIcl(SensorKind sensor, const std::string& name, const std::string& description, int argc,
           char** argv) {
  CLI::App app(description, name);
  RunArguments arguments;
  arguments.sensor = sensor;
  IclSequenceOptions icl;
  std::vector<std::string> positional;
  AddRunArguments(app, IclHelp(), arguments, positional);
  AddIclArguments(app, icl);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  FinishArguments(positional, arguments);
  const SystemOptions options = LoadIclOptions(arguments);
  return RunSlam(arguments, options, OpenIcl(arguments, icl, options));
}

}  // namespace hullslam
