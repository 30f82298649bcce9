// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on a recording of ROS.
#include "run/datasets/bag_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.name = "mono_bag",
                                   .description = "Runs monocular SLAM on a recording of ROS.",
                                   .sensor = hullslam::SensorKind::kMonocular},
                                  hullslam::MakeBagDataset(), argc, argv);
}
