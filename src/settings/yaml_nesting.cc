// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_nesting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr size_t kMostBrackets = 500;     // '[' and '{' in the whole file
constexpr size_t kMostIndentation = 200;  // blanks before a line
constexpr size_t kMostIndicators = 200;   // '-', ':' and '?' in a line

size_t Count(std::string_view text, std::string_view characters) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [&](char c) {
    return characters.find(c) != std::string_view::npos;
  }));
}

// The line without its comment. If there is a quote before the '#', the '#' may be part of a text,
// so nothing is removed.
std::string_view WithoutComment(std::string_view line) {
  const size_t comment = line.find('#');
  const size_t quote = line.find_first_of("\"'");
  return comment < quote ? line.substr(0, comment) : line;
}

}  // namespace

void CheckYamlNesting(const std::filesystem::path& file, std::string_view text) {
  size_t brackets = 0;
  int number = 1;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    const std::string_view line = WithoutComment(text.substr(begin, end - begin));
    begin = end + 1;
    brackets += Count(line, "[{");
    const size_t content = std::min(line.find_first_not_of(' '), line.size());
    if (brackets > kMostBrackets || (content > kMostIndentation && content < line.size()) ||
        Count(line, "-:?") > kMostIndicators) {
      throw InputError(fmt::format("{}:{}: is nested too deep, expected lines of 'key: value'",
                                   file.string(), number));
    }
    number += end < text.size() && text[end] == '\n' ? 1 : 0;
  }
}

}  // namespace hullslam
