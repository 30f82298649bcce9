// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hullslam {

// A number and what it counts, for messages: "1 keyframe", "0 keyframes". `noun` is in the
// singular and has a plural in -s.
inline std::string Counted(size_t number, std::string_view noun) {
  return std::to_string(number).append(" ").append(noun).append(number == 1 ? "" : "s");
}

}  // namespace hullslam
