// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a sequence in TUM format.
#include "run/datasets/tum_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.name = "rgbd_tum",
                                   .description = "Runs RGB-D SLAM on a sequence in TUM format.",
                                   .sensor = hullslam::SensorKind::kRgbd},
                                  hullslam::MakeTumDataset(), argc, argv);
}
