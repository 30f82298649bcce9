// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on a video file or a folder of images.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.sensor = hullslam::SensorKind::kMonocular,
       .dataset = "video",
       .description = "Runs monocular SLAM on a video file or a folder of images."},
      argc, argv);
}
