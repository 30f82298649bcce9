// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hullslam {

// The absolute path without links, "." and "..", also of a file or folder that does not exist yet.
// It does not end in a slash.
std::filesystem::path CanonicalPath(const std::filesystem::path& path);

// The last name of this path: the name of the folder or file, also if `path` ends in a slash.
std::string CanonicalName(const std::filesystem::path& path);

// Whether `path` is the folder or file `outer`, or inside of this folder. Both paths may be of any
// form.
bool IsSameOrInside(const std::filesystem::path& path, const std::filesystem::path& outer);

// The file that contains this code: a program, a shared library or a module of Python. Empty if the
// system cannot tell.
std::filesystem::path FileOfThisCode();

// A file or folder that is installed with HullSLAM, such as "config". It is searched as
// share/hullslam/NAME in the folder that this code is installed in (as a program, shared library or
// Python module; the folder may have been moved), then in the prefix of the configuration, and last
// as NAME in the source tree. Throws InputError, which lists these folders and ends with `hint`, if
// there is none of them.
std::filesystem::path FindData(const std::filesystem::path& name, std::string_view hint);

// Whether `a` comes before `b` if digits that follow each other are compared as numbers: frame2
// before frame10. Names that differ in leading zeros only are ordered by their characters, so this
// is a strict total order.
bool IsNaturallyBefore(std::string_view a, std::string_view b);

}  // namespace hullslam
