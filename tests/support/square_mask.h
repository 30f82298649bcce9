// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// A mask in the shape of a square, in raw pixels.
inline InstanceMask Square(const std::string& label, double left, double top, double side) {
  InstanceMask mask;
  mask.label = label;
  mask.outlines = {
      {{left, top}, {left + side, top}, {left + side, top + side}, {left, top + side}}};
  return mask;
}

}  // namespace hullslam
