// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace hullslam {

// The page of the report and of the live view as one HTML file, made by scripts/assemble_page.py.
// The position of its data is marked by @DATA@, which occurs once. Without data, the page is empty
// until a message is given to it.
std::string_view PageTemplate();

}  // namespace hullslam
