// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// The names in the metadata "names" of a network: a dictionary as Ultralytics writes it,
// {0: 'person', 1: "driver's cab"}, also with numbers in quotes, or a list. Absent if the text is
// nothing of the kind, or if the numbers do not run from 0.
std::optional<std::vector<std::string>> ParseClassNames(std::string_view text);

// The names in a text file, one per line. Throws InputError for a file without names, and with the
// line for an empty line, a name that comes again or one that CheckClassNames() refuses.
std::vector<std::string> ReadClassNames(const std::filesystem::path& path);

// Throws InputError that begins with `source` unless the names can be written one per line and read
// again: each is in UTF-8, has no control characters and no blanks around it, and none comes twice.
void CheckClassNames(const std::string& source, const std::vector<std::string>& names);

}  // namespace hullslam
