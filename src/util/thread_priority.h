// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The niceness of threads in the background (setpriority(2)).
inline constexpr int kBackgroundNiceness = 10;

// Gives the calling thread at least this niceness. The thread then gets a smaller share of a core
// that other threads need too. With niceness 10 it gets about a tenth of a core that it shares with
// one thread of niceness 0.
void RunInBackground(int niceness = kBackgroundNiceness);

}  // namespace hullslam
