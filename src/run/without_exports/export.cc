// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/program.h"
#include "run/tools/commands.h"
#include "util/components.h"

namespace hullslam {

int RunExport(int, char**) {
  RequireComponent("EXPORTS", "an export is asked for");
  return kFailed;
}

int RunMesh(int, char**) {
  RequireComponent("EXPORTS", "a mesh is asked for");
  return kFailed;
}

}  // namespace hullslam
