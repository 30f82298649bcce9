// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace hullslam {

// The absolute path without links, "." and "..", also of a file or folder that does not exist yet.
// It does not end in a slash.
std::filesystem::path CanonicalPath(const std::filesystem::path& path);

// The last name of this path: the name of the folder or file, also if `path` ends in a slash.
std::string CanonicalName(const std::filesystem::path& path);

// Whether `path` is the folder or file `outer`, or inside of this folder. Both paths may be of any
// form.
bool IsSameOrInside(const std::filesystem::path& path, const std::filesystem::path& outer);

}  // namespace hullslam
