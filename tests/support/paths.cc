// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/paths.h"

namespace hullslam {

std::filesystem::path SourceFolder() { return HULLSLAM_SOURCE_DIR; }
std::filesystem::path ProgramFolder() { return HULLSLAM_BIN_DIR; }

}  // namespace hullslam
