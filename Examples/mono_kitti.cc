// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the left camera of a sequence of KITTI's odometry benchmark.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.sensor = hullslam::SensorKind::kMonocular,
       .dataset = "kitti",
       .description =
           "Runs monocular SLAM on the left camera of a sequence of KITTI's odometry benchmark."},
      argc, argv);
}
