// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace hullslam {

// Whether `a` comes before `b` if digits that follow each other are compared as numbers: frame2
// before frame10. Names that differ in leading zeros only are ordered by their characters, so this
// is a strict total order.
bool IsNaturallyBefore(std::string_view a, std::string_view b);

}  // namespace hullslam
