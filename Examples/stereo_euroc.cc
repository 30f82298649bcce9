// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a sequence of EuRoC.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.sensor = hullslam::SensorKind::kStereo,
                                   .dataset = "euroc",
                                   .description = "Runs stereo SLAM on a sequence of EuRoC."},
                                  argc, argv);
}
