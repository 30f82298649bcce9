// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "view/view_model.h"

namespace hullslam {

// The page with this message of FormatViewMessage() inside; without data if it is empty.
std::string FormatPage(std::string_view message);

// report.html: one file that shows the model and needs nothing else.
std::string FormatReport(const ViewModel& model);

// The page of the report and of the live view as one HTML file, made by scripts/assemble_page.py.
// The position of its data is marked by @DATA@, which occurs once. Without data, the page is empty
// until a message is given to it.
std::string_view PageTemplate();

}  // namespace hullslam
