// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the colour images of a sequence of ICL-NUIM.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.sensor = hullslam::SensorKind::kMonocular,
       .dataset = "icl",
       .description = "Runs monocular SLAM on the colour images of a sequence of ICL-NUIM."},
      argc, argv);
}
