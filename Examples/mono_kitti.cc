// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the left camera of a sequence of KITTI's odometry benchmark.
#include "run/datasets/kitti_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.name = "mono_kitti",
       .description =
           "Runs monocular SLAM on the left camera of a sequence of KITTI's odometry benchmark.",
       .sensor = hullslam::SensorKind::kMonocular},
      hullslam::MakeKittiLeftDataset(), argc, argv);
}
