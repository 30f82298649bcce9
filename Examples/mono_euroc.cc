// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the left camera of a sequence of EuRoC.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.sensor = hullslam::SensorKind::kMonocular,
       .dataset = "euroc",
       .description = "Runs monocular SLAM on the left camera of a sequence of EuRoC."},
      argc, argv);
}
