// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/eval/ate.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

struct TrajectoryArguments {
  std::string groundtruth;
  std::string estimate;
  AteOptions ate;
  bool json = false;
};

// `arguments` must outlive the app.
CLI::App* AddTrajectoryCommand(CLI::App& app, TrajectoryArguments& arguments);

// Prints the absolute and relative errors of a trajectory. Throws InputError for bad files, and if
// no two poses of the trajectories can be paired.
void RunTrajectoryCommand(const TrajectoryArguments& arguments);

}  // namespace hullslam
