// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <source_location>
#include <stdexcept>
#include <string_view>

namespace hullslam {

// A broken precondition or invariant: a mistake in a program, never in its input.
class CheckError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// Throws CheckError with `what` and the caller's place unless `condition` holds.
void Check(bool condition, std::string_view what,
           std::source_location where = std::source_location::current());

namespace internal {
[[noreturn]] void FailCheck(std::string_view what, const std::source_location& where);
}

inline void Check(bool condition, std::string_view what, std::source_location where) {
  if (!condition) [[unlikely]] {
    internal::FailCheck(what, where);
  }
}

}  // namespace hullslam
