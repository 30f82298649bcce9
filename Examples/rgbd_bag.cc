// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a recording of ROS.
#include "run/datasets/bag_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.name = "rgbd_bag",
                                   .description = "Runs RGB-D SLAM on a recording of ROS.",
                                   .sensor = hullslam::SensorKind::kRgbd},
                                  hullslam::MakeBagDataset(), argc, argv);
}
