// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/program.h"

namespace hullslam {

std::string GitRevision() { return HULLSLAM_GIT; }

}  // namespace hullslam
