// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string_view>

namespace hullslam {

// A broken precondition or invariant: an error in the program, never in its input.
class CheckError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace internal {
[[noreturn]] void FailCheck(std::string_view what, const char* file, int line);
}

// Throws CheckError with `what` and the caller's file and line unless `condition` holds. (The
// builtins are used because the clang-tidy of Debian 12 does not know std::source_location.)
inline void Check(bool condition, std::string_view what, const char* file = __builtin_FILE(),
                  int line = __builtin_LINE()) {
  if (!condition) [[unlikely]] {
    internal::FailCheck(what, file, line);
  }
}

}  // namespace hullslam
