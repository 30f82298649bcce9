// SPDX-License-Identifier: GPL-3.0-or-later
// Runs RGB-D SLAM on a sequence of ICL-NUIM.
#include "run/slam_program.h"

int main(int argc, char** argv) {
  return hullslam::RunSlamProgram({.sensor = hullslam::SensorKind::kRgbd,
                                   .dataset = "icl",
                                   .description = "Runs RGB-D SLAM on a sequence of ICL-NUIM."},
                                  argc, argv);
}
