// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/git_revision.h"

namespace hullslam {

std::string GitRevision() { return HULLSLAM_GIT; }

}  // namespace hullslam
