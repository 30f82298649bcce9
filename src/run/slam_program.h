// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/frame/sensor.h"

namespace hullslam {

struct SlamProgram {
  SensorKind sensor = SensorKind::kRgbd;
  std::string dataset;      // Dataset::program, such as "tum"
  std::string description;  // for --help
};

// A whole program, whose name is that of the sensor and of the data set, such as rgbd_tum: parses
// the command line, opens the sequence, runs SLAM and prints errors. Returns the exit code.
int RunSlamProgram(const SlamProgram& program, int argc, char** argv);

}  // namespace hullslam
