// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The niceness of threads in the background (setpriority(2)).
inline constexpr int kBackgroundNiceness = 10;

// From now on the calling thread gets a core for long only if other threads leave one idle.
void RunInBackground();

}  // namespace hullslam
