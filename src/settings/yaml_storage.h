// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

namespace hullslam {

// Parses the text of a file, which must begin with `%YAML`. The first `added_lines` of the text are
// not in the file. Throws InputError with file and line.
cv::FileStorage ParseYaml(const std::filesystem::path& file, const std::string& text,
                          int added_lines = 0);

// Throws an InputError with file and line for an exception of OpenCV's parser.
[[noreturn]] void FailParsing(const std::filesystem::path& file, const cv::Exception& error,
                              int added_lines = 0);

}  // namespace hullslam
