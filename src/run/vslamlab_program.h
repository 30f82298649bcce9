// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"

namespace hullslam {

// A whole program in the contract of VSLAM-LAB (docs/benchmarks.md): takes arguments `key:value`,
// runs SLAM on the images of a rgb.csv, and writes EXP_ID_KeyFrameTrajectory.csv. Returns the exit
// code.
int RunVslamlabProgram(SensorKind sensor, int argc, char** argv);

}  // namespace hullslam
