// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace hullslam {

// Messages of a program. Unlike fmt::print(), they never throw: a full disk or a closed pipe behind
// stdout or stderr must not end a run. RunMain() checks stdout at the end of the program.
inline void PrintText(std::FILE* stream, const std::string& text) {
  [[maybe_unused]] const size_t written = std::fwrite(text.data(), 1, text.size(), stream);
}

template <typename... Values>
void Print(fmt::format_string<Values...> format, Values&&... values) {
  PrintText(stdout, fmt::format(format, std::forward<Values>(values)...));
}

template <typename... Values>
void PrintError(fmt::format_string<Values...> format, Values&&... values) {
  PrintText(stderr, fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace hullslam
