// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>

namespace hullslam {

// The number of characters to insert, remove or replace to make `a` from `b` (Levenshtein 1966).
// Messages use it to suggest the right name for a misspelt one.
size_t EditDistance(std::string_view a, std::string_view b);

// Whether `written` may be a misspelt `known`: one character in four is wrong at most, or two in
// short names, but never more than half of the part behind the last dot. Names that differ in
// numbers only, as Camera.k4 and Camera.k1, are different things.
bool IsMisspelt(std::string_view written, std::string_view known);

}  // namespace hullslam
