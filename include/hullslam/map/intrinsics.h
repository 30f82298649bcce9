// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/camera/pinhole.h"
#include "hullslam/costs/projection.h"

namespace hullslam {

inline Intrinsics ToIntrinsics(const PinholeCamera& camera) {
  return {.fx = camera.fx, .fy = camera.fy, .cx = camera.cx, .cy = camera.cy, .bf = camera.bf};
}

}  // namespace hullslam
