// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace hullslam {

// An error in the input that the user can correct: a missing file, a malformed line, an option out
// of range. The message names the file and line, or the key and value, and says what was expected.
// Programs print it and exit with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hullslam
