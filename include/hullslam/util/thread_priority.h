// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// From now on the calling thread gets a core for long only if other threads leave one idle.
inline constexpr int kBackgroundNiceness = 10;
void RunInBackground();

}  // namespace hullslam
