// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_storage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "hullslam/util/error.h"
#include "settings/yaml_nesting.h"

namespace hullslam {

cv::FileStorage ParseYaml(const std::filesystem::path& file, const std::string& text,
                          int added_lines) {
  CheckYamlNesting(file, text);
  try {
    return cv::FileStorage(
        text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  } catch (const cv::Exception& error) {
    FailParsing(file, error, added_lines);
  } catch (const std::length_error&) {  // some broken texts make the parser build a huge string
    throw InputError(file.string() + ": is not valid YAML");
  }
}

// OpenCV's parser puts "(line): message" into the field for the name of the function.
void FailParsing(const std::filesystem::path& file, const cv::Exception& error, int added_lines) {
  int line = 0;
  char reason[200] = "is not valid YAML";
  if (std::sscanf(error.func.c_str(), "(%d): %199[^\n]", &line, reason) >= 1) {
    throw InputError(
        fmt::format("{}:{}: {}", file.string(), std::max(1, line - added_lines), reason));
  }
  throw InputError(file.string() + ": is not valid YAML");
}

}  // namespace hullslam
