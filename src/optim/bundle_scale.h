// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"
#include "optim/bundle_result.h"

namespace hullslam {

// Without depth, a bundle adjustment with a single fixed keyframe does not determine the scale: the
// whole result may shrink towards the centre of that camera. This gives the result the scale that
// the map had: the sum of the distances of the moving cameras from the fixed one is as before. The
// residuals do not change.
void KeepScale(const Map& map, KeyframeId fixed, BundleResult& result);

}  // namespace hullslam
