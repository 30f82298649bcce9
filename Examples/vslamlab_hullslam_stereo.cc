// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stereo SLAM as a baseline of VSLAM-LAB.
#include "run/vslamlab_program.h"

int main(int argc, char** argv) {
  return hullslam::RunVslamlabProgram(hullslam::SensorKind::kStereo, argc, argv);
}
