// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "run/datasets/dataset.h"

namespace hullslam {

struct SlamProgram {
  std::string name;         // "rgbd_tum"
  std::string description;  // for --help
  SensorKind sensor = SensorKind::kRgbd;
};

// A whole program: parses the command line, opens the sequence, runs SLAM and prints errors.
// Returns the exit code.
int RunSlamProgram(const SlamProgram& program, std::unique_ptr<Dataset> dataset, int argc,
                   char** argv);

}  // namespace hullslam
