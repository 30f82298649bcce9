// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// A camera whose pixels are not square.
inline constexpr PinholeCamera kReprojectionCamera{
    .fx = 500.0, .fy = 400.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

}  // namespace hullslam
