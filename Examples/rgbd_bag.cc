// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a recording of ROS.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.sensor = hullslam::SensorKind::kRgbd,
                                   .dataset = "bag",
                                   .description = "Runs RGB-D SLAM on a recording of ROS."},
                                  argc, argv);
}
