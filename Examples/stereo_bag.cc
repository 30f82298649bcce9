// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a recording of ROS.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.sensor = hullslam::SensorKind::kStereo,
                                   .dataset = "bag",
                                   .description = "Runs stereo SLAM on a recording of ROS."},
                                  argc, argv);
}
