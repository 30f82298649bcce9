// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a sequence of KITTI's odometry benchmark.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.sensor = hullslam::SensorKind::kStereo,
       .dataset = "kitti",
       .description = "Runs stereo SLAM on a sequence of KITTI's odometry benchmark."},
      argc, argv);
}
