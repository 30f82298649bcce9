// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a sequence of EuRoC.
#include "run/datasets/stereo_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.name = "stereo_euroc",
                                   .description = "Runs stereo SLAM on a sequence of EuRoC.",
                                   .sensor = hullslam::SensorKind::kStereo},
                                  hullslam::MakeEurocStereoDataset(), argc, argv);
}
