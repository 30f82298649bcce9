// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace hullslam {

std::filesystem::path SourceFolder();   // the folder of the project
std::filesystem::path ProgramFolder();  // where the built programs are

}  // namespace hullslam
