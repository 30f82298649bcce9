// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a recording of ROS.
#include "run/datasets/stereo_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.name = "stereo_bag",
                                   .description = "Runs stereo SLAM on a recording of ROS.",
                                   .sensor = hullslam::SensorKind::kStereo},
                                  hullslam::MakeStereoBagDataset(), argc, argv);
}
