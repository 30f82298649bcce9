// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace hullslam {

// Splits a list of names at its commas and removes the blanks around each name: "person, cat" gives
// two names.
std::set<std::string> SplitNames(std::string_view names);

}  // namespace hullslam
