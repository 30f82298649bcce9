// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the colour images of a sequence in TUM format.
#include "run/datasets/tum_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.name = "mono_tum",
       .description = "Runs monocular SLAM on the colour images of a sequence in TUM format.",
       .sensor = hullslam::SensorKind::kMonocular},
      hullslam::MakeTumDataset(), argc, argv);
}
