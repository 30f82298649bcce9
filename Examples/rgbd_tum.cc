// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a sequence in TUM format.
#include "cli/program.h"
#include "cli/run_arguments.h"
#include "cli/slam_run.h"
#include "hullslam/sequences/tum_sequence.h"

int main(int argc, char** argv) {
  return hullslam::RunMain(
      [](int count, char** words) {
        CLI::App app("Runs RGB-D SLAM on a sequence in TUM format.", "rgbd_tum");
        hullslam::RunArguments arguments;
        std::vector<std::string> positional;
        hullslam::AddRunArguments(
            app,
            {.sequence = "folder with rgb.txt and depth.txt",
             .settings = "default: camera.yaml in SEQUENCE; without it, the file in config/ that "
                         "fits the folder's name, such as TUM1.yaml for freiburg1",
             .associations = "stamp rgb stamp depth (default: images are paired by their stamps, "
                             "at most 0.02 s apart)"},
            arguments, positional);
        if (!hullslam::ParseCommandLine(app, count, words)) {
          return static_cast<int>(hullslam::kDone);
        }
        hullslam::FinishArguments(positional, arguments);
        const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(
            arguments.sequence,
            {.associations = arguments.associations, .selection = arguments.selection});
        return hullslam::RunSlam(arguments, hullslam::LoadOptions(arguments), sequence);
      },
      argc, argv);
}
