// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace hullslam {

// The text without the blanks, tabs and carriage returns at both of its ends.
inline std::string_view Trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace hullslam
