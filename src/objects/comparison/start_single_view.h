// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "objects/start_method.h"

namespace hullslam {

// `single_view` (VOOM, Wang et al. 2024, and the constructor of the released Object.cc): the first
// view with depth gives an ellipsoid that faces its camera. Its centre is at the median depth of
// the mask in the middle of the bounding box, its width and height are those of the box there, and
// its thickness is the extent of the depths in the mask (their 5 % to 95 % quantile), bounded to
// 0.05 and 0.2 m. Without depth, StartByRays().
std::vector<Ellipsoid> StartBySingleView(const StartInput& input);

}  // namespace hullslam
