// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the images of the left camera of a sequence of EuRoC.
#include "cli/input_warnings.h"
#include "cli/program.h"
#include "cli/run_arguments.h"
#include "cli/slam_run.h"
#include "hullslam/io/euroc_sequence.h"

namespace {

// The settings of --settings, else the camera of the sequence and defaults.
hullslam::SystemOptions LoadEurocOptions(const hullslam::RunArguments& arguments,
                                         const hullslam::EurocSequence& sequence) {
  hullslam::SystemOptions options =
      arguments.settings.empty()
          ? hullslam::LoadSettings(sequence.camera.calibration, arguments.sequence.string(),
                                   arguments.overrides)
          : hullslam::LoadSettings(arguments.settings, arguments.overrides);
  options.sensor = arguments.sensor;
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  return hullslam::RunMain(
      [](int count, char** words) {
        CLI::App app("Runs monocular SLAM on the left camera of a sequence of EuRoC.",
                     "mono_euroc");
        hullslam::RunArguments arguments;
        arguments.sensor = hullslam::SensorKind::kMonocular;
        std::vector<std::string> positional;
        hullslam::AddRunArguments(
            app,
            {.sequence = "folder with mav0, in the format ASL",
             .settings = "default: the camera of cam0/sensor.yaml in SEQUENCE"},
            arguments, positional);
        if (!hullslam::ParseCommandLine(app, count, words)) {
          return static_cast<int>(hullslam::kDone);
        }
        hullslam::FinishArguments(positional, arguments);
        const hullslam::EurocSequence sequence =
            hullslam::OpenEurocSequence(arguments.sequence, arguments.selection);
        return hullslam::RunSlam(arguments, LoadEurocOptions(arguments, sequence), sequence.images);
      },
      argc, argv);
}
