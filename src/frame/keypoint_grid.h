// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_grid.h"

namespace hullslam {

// The grid of the keypoints of an image, in its raw pixels.
FeatureGrid MakeKeypointGrid(std::span<const Keypoint> keypoints, const PinholeCamera& camera);

}  // namespace hullslam
