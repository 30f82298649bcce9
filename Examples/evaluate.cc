// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates finished runs: the error of a trajectory against ground truth, and the mapped objects.
#include "cli/program.h"
#include "cli/version.h"
#include "evaluate/objects_command.h"
#include "evaluate/trajectory_command.h"

namespace hullslam {
namespace {

int Run(int argc, char** argv) {
  CLI::App app("Evaluates finished runs.", "evaluate");
  AddVersionAndExitCodes(app);
  TrajectoryArguments trajectory;
  ObjectsArguments objects;
  const CLI::App* const trajectory_command = AddTrajectoryCommand(app, trajectory);
  AddObjectsCommand(app, objects);
  app.require_subcommand(1);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  if (trajectory_command->parsed()) {
    RunTrajectoryCommand(trajectory);
  } else {
    RunObjectsCommand(objects);
  }
  return kDone;
}

}  // namespace
}  // namespace hullslam

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::Run, argc, argv); }
