// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a sequence of KITTI's odometry benchmark.
#include "run/datasets/stereo_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.name = "stereo_kitti",
       .description = "Runs stereo SLAM on a sequence of KITTI's odometry benchmark.",
       .sensor = hullslam::SensorKind::kStereo},
      hullslam::MakeKittiDataset(), argc, argv);
}
