// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"
#include "optim/bundle_result.h"

namespace hullslam {

// A monocular bundle adjustment with a single fixed keyframe does not determine the scale: the
// whole result may shrink towards the centre of that camera without a change of the residuals.
// KeepScale scales the result about this centre, so that the sum of the distances of the moving
// cameras from the fixed one is the same as before the adjustment.
void KeepScale(const Map& map, KeyframeId fixed, BundleResult& result);

}  // namespace hullslam
