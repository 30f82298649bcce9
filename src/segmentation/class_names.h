// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// The names in the metadata "names" of a network that Ultralytics exported: a dictionary of Python,
// {0: 'person', 1: "driver's cab"}. Absent if the text is nothing of the kind, or if the numbers do
// not run from 0.
std::optional<std::vector<std::string>> ParseClassNames(std::string_view text);

// The names in a text file, one per line. Throws InputError for a file without names, and with the
// line for an empty line or a name that comes again.
std::vector<std::string> ReadClassNames(const std::filesystem::path& path);

}  // namespace hullslam
