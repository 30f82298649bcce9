// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on a video file or a folder of images.
#include "run/datasets/video_dataset.h"
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram(
      {.name = "mono_video",
       .description = "Runs monocular SLAM on a video file or a folder of images.",
       .sensor = hullslam::SensorKind::kMonocular},
      hullslam::MakeVideoDataset(), argc, argv);
}
