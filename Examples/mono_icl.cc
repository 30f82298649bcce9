// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on the colour images of a sequence of ICL-NUIM.
#include "run/datasets/icl_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.name = "mono_icl",
       .description = "Runs monocular SLAM on the colour images of a sequence of ICL-NUIM.",
       .sensor = hullslam::SensorKind::kMonocular},
      hullslam::MakeIclDataset(), argc, argv);
}
