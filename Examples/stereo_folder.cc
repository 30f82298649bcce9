// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a folder or a video of pairs.
#include "run/datasets/stereo_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.name = "stereo_folder",
       .description = "Runs stereo SLAM on a folder or a video of pairs.",
       .sensor = hullslam::SensorKind::kStereo},
      hullslam::MakeStereoFolderDataset(), argc, argv);
}
