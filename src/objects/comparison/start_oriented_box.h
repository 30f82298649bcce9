// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "objects/start_method.h"

namespace hullslam {

// `oriented_box` (Song et al. 2022, Yu et al. 2025): the ellipsoid in the oriented bounding box of
// the points inside the masks. These are depth points or, without depth, landmarks. The share
// `trimmed` is left out at each end of each axis, and the half axes take the inflation.
std::vector<Ellipsoid> StartByOrientedBox(const StartInput& input);

}  // namespace hullslam
