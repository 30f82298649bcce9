// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace hullslam {

// The file that contains this code: a program, a shared library or a module of Python. Empty if the
// system cannot tell.
std::filesystem::path FileOfThisCode();

// A file or folder that is installed with HullSLAM, such as "config". It is searched as
// share/hullslam/NAME in the folder that this code is installed in (as a program, shared library or
// Python module; the folder may have been moved), then in the prefix of the configuration, and last
// as NAME in the source tree. Throws InputError, which lists these folders and ends with `hint`, if
// there is none of them.
std::filesystem::path FindData(const std::filesystem::path& name, std::string_view hint);

}  // namespace hullslam
