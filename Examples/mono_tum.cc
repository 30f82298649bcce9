// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the colour images of a sequence in TUM format.
#include "cli/program.h"
#include "cli/run_arguments.h"
#include "cli/slam_run.h"
#include "hullslam/sequences/tum_sequence.h"

int main(int argc, char** argv) {
  return hullslam::RunMain(
      [](int count, char** words) {
        CLI::App app("Runs monocular SLAM on the colour images of a sequence in TUM format.",
                     "mono_tum");
        hullslam::RunArguments arguments;
        arguments.sensor = hullslam::SensorKind::kMonocular;
        std::vector<std::string> positional;
        hullslam::AddRunArguments(
            app,
            {.sequence = "folder with rgb.txt",
             .settings = "default: camera.yaml in SEQUENCE; without it, the file in config/ that "
                         "fits the folder's name, such as TUM1.yaml for freiburg1"},
            arguments, positional);
        if (!hullslam::ParseCommandLine(app, count, words)) {
          return static_cast<int>(hullslam::kDone);
        }
        hullslam::FinishArguments(positional, arguments);
        return hullslam::RunSlam(
            arguments, hullslam::LoadOptions(arguments),
            hullslam::OpenTumSequence(arguments.sequence,
                                      {.use_depth = false, .selection = arguments.selection}));
      },
      argc, argv);
}
