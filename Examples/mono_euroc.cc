// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the left camera of a sequence of EuRoC.
#include "run/datasets/euroc_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.name = "mono_euroc",
       .description = "Runs monocular SLAM on the left camera of a sequence of EuRoC.",
       .sensor = hullslam::SensorKind::kMonocular},
      hullslam::MakeEurocDataset(), argc, argv);
}
