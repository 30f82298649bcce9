// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on a recording of ROS.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.sensor = hullslam::SensorKind::kMonocular,
                                   .dataset = "bag",
                                   .description = "Runs monocular SLAM on a recording of ROS."},
                                  argc, argv);
}
