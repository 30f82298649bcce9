// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a sequence in TUM format.
#include "cli/program.h"
#include "cli/rgbd_run.h"
#include "cli/run_arguments.h"

int main(int argc, char** argv) {
  return hullslam::RunMain(
      [](int count, char** words) {
        CLI::App app("Runs RGB-D SLAM on a sequence in TUM format.", "rgbd_tum");
        hullslam::RunArguments arguments;
        std::vector<std::string> positional;
        hullslam::AddRunArguments(app, arguments, positional);
        if (!hullslam::ParseCommandLine(app, count, words)) {
          return static_cast<int>(hullslam::kDone);
        }
        hullslam::FinishArguments(positional, arguments);
        return hullslam::RunRgbd(arguments,
                                 hullslam::OpenTumSequence(arguments.sequence, arguments.tum));
      },
      argc, argv);
}
