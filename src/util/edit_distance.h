// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>

namespace hullslam {

// The number of characters to insert, remove or replace to make `a` from `b` (Levenshtein 1966).
// Messages use it to suggest the right name for a misspelt one.
size_t EditDistance(std::string_view a, std::string_view b);

}  // namespace hullslam
