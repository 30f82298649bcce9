// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a sequence of ICL-NUIM.
#include "run/datasets/icl_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.name = "rgbd_icl",
                                   .description = "Runs RGB-D SLAM on a sequence of ICL-NUIM.",
                                   .sensor = hullslam::SensorKind::kRgbd},
                                  hullslam::MakeIclDataset(), argc, argv);
}
