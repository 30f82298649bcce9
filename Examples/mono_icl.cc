// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the colour images of a sequence of ICL-NUIM.
#include "cli/icl_arguments.h"
#include "cli/program.h"
#include "cli/run_arguments.h"
#include "cli/slam_run.h"

int main(int argc, char** argv) {
  return hullslam::RunMain(
      [](int count, char** words) {
        CLI::App app("Runs monocular SLAM on the colour images of a sequence of ICL-NUIM.",
                     "mono_icl");
        hullslam::RunArguments arguments;
        arguments.sensor = hullslam::SensorKind::kMonocular;
        hullslam::IclSequenceOptions icl;
        std::vector<std::string> positional;
        hullslam::AddRunArguments(app, hullslam::IclHelp(), arguments, positional);
        hullslam::AddIclArguments(app, icl);
        if (!hullslam::ParseCommandLine(app, count, words)) {
          return static_cast<int>(hullslam::kDone);
        }
        hullslam::FinishArguments(positional, arguments);
        const hullslam::SystemOptions options = hullslam::LoadIclOptions(arguments);
        const hullslam::ImageSequence sequence = hullslam::OpenIcl(arguments, icl, options);
        return hullslam::RunSlam(arguments, options, sequence);
      },
      argc, argv);
}
