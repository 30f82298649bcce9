// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a sequence of ICL-NUIM.
#include "cli/icl_arguments.h"
#include "cli/program.h"

int main(int argc, char** argv) {
  return hullslam::RunMain(
      [](int count, char** words) {
        return hullslam::RunIcl(hullslam::SensorKind::kRgbd, "rgbd_icl",
                                "Runs RGB-D SLAM on a sequence of ICL-NUIM.", count, words);
      },
      argc, argv);
}
