// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace hullslam {

// Throws InputError with file and line if the text of a YAML file may be nested very deep. OpenCV's
// parser calls itself for each level, and too many levels overflow the stack. Settings need at most
// three levels. The check is rough, because it does not parse the text: it counts the characters
// that can start a level, and its limits are far above the counts in any settings file.
void CheckYamlNesting(const std::filesystem::path& file, std::string_view text);

}  // namespace hullslam
