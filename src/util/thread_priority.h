// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The niceness of threads in the background (setpriority(2)).
inline constexpr int kBackgroundNiceness = 10;

// From now on the calling thread has at least this niceness, and so a smaller share of a core that
// other threads want too: with 10, about a tenth of it beside one thread of niceness 0.
void RunInBackground(int niceness = kBackgroundNiceness);

}  // namespace hullslam
