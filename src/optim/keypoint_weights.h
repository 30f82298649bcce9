// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/map/keyframe.h"

namespace hullslam::internal {

// The weight of each keypoint of a keyframe: in (0, 1] if it shows a landmark, otherwise 0. All
// that show landmarks at its place (less than 3 px away in x and in y) weigh together as much as
// the most precise of them.
//
// A corner is found at several levels of the pyramid, so it makes several landmarks with the same
// error. Without the weights it would count as often, most of all if it is no point at all: where
// an edge passes behind another, the corner slides along both.
std::vector<double> KeypointWeights(const Keyframe& keyframe, const ScaleLevels& levels);

}  // namespace hullslam::internal
