// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace hullslam {

// The revision that this program was configured from, as `git describe` gives it; empty outside of
// a clone.
std::string GitRevision();

}  // namespace hullslam
