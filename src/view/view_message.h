// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "view/view_model.h"

namespace hullslam {

inline constexpr int kViewVersion = 1;

// The message that sets all parts of the page (docs/view_data.md): JSON in one line, in which every
// "<" is escaped, so that it may stand inside a script element of HTML. Times are relative to the
// first pose.
std::string FormatViewMessage(const ViewModel& model);

}  // namespace hullslam
