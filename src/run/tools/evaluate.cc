// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/tools/evaluate.h"

#include <CLI/CLI.hpp>

#include "run/command_line.h"
#include "run/program.h"
#include "run/tools/commands.h"

namespace hullslam {
int RunEvaluate(int argc, char** argv) {
  CLI::App app("Evaluates finished runs.", argv[0]);
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

}  // namespace hullslam
