// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "util/text.h"

namespace hullslam {

// Messages of a program. Unlike fmt::print(), they never throw: a full disk or a closed pipe behind
// stdout or stderr must not end a run. RunMain() checks stdout at the end of the program.

// The text as it is, for what the program itself controls a terminal with.
inline void PrintText(std::FILE* stream, const std::string& text) {
  [[maybe_unused]] const size_t written = std::fwrite(text.data(), 1, text.size(), stream);
}

// Names of files and of classes come from outside, so both functions replace what is not printable.

// For a report of any number of lines.
template <typename... Values>
void Print(fmt::format_string<Values...> format, Values&&... values) {
  PrintText(stdout, Printable(fmt::format(format, std::forward<Values>(values)...), "\n"));
}

// For a message of one line, which ends in "\n". No name in it can begin another line.
template <typename... Values>
void PrintError(fmt::format_string<Values...> format, Values&&... values) {
  std::string line = fmt::format(format, std::forward<Values>(values)...);
  const bool has_end = line.ends_with('\n');
  if (has_end) {
    line.pop_back();
  }
  PrintText(stderr, Printable(line) + (has_end ? "\n" : ""));
}

inline void PrintWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    PrintError("warning: {}\n", warning);
  }
}

}  // namespace hullslam
