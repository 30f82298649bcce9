// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/program.h"
#include "run/tools/commands.h"
#include "util/components.h"

namespace hullslam {

int RunQueryObjects(int, char**) {
  RequireComponent("SCENE", "a question is asked");
  return kFailed;
}

}  // namespace hullslam
