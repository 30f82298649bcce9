// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// Standard deviations of the prior on an ellipsoid.
struct QuadricPriorSigmas {
  double log_axes = 0.5;  // natural logarithm of each half axis
  double center = 0.5;    // relative to the geometric mean of the half axes of the prior's shape
  double rotation = 0.5;  // radians
};

}  // namespace hullslam
