// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "costs/make_object_cost.h"
#include "hullslam/frame/detection.h"

namespace hullslam {

// What a detection offers to the costs. It refers to the detection.
inline ObjectMeasurement ToMeasurement(const Detection& detection) {
  return {.lines = detection.lines,
          .contour = detection.contour,
          .hull = detection.hull,
          .ellipse = detection.ellipse,
          .box = detection.box};
}

}  // namespace hullslam
