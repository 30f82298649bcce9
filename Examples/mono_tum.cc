// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the colour images of a sequence in TUM format.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.sensor = hullslam::SensorKind::kMonocular,
       .dataset = "tum",
       .description = "Runs monocular SLAM on the colour images of a sequence in TUM format."},
      argc, argv);
}
