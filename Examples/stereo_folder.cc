// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM on a folder or a video of pairs.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.sensor = hullslam::SensorKind::kStereo,
       .dataset = "folder",
       .description = "Runs stereo SLAM on a folder or a video of pairs."},
      argc, argv);
}
