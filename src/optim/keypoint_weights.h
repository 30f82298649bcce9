// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/map/keyframe.h"

namespace hullslam::internal {

// The weights of the keypoints of a keyframe in bundle adjustment.
//
// A corner is often found at several levels of the pyramid, which makes several landmarks with the
// same error. Without weights its error would count several times. That does most harm where the
// corner is no point of the world: where one edge passes behind another, the corner slides along
// both.
//
// Let N_k be the keypoints that show a landmark and are less than 3 px away from keypoint k in x
// and in y, including k, and let i_j = 1 / sigma_j^2 be the information of keypoint j at its
// pyramid level. The weight of the squared error of k is
//   w_k = max over N_k of i_j / sum over N_k of i_j.
// So if all keypoints of a group are near each other, their total information, sum of w_k i_k, is
// that of the most precise keypoint. A keypoint without such neighbours has weight 1. Returns one
// weight per keypoint, in (0, 1], or 0 where the keypoint shows no landmark.
std::vector<double> KeypointWeights(const Keyframe& keyframe, const ScaleLevels& levels);

}  // namespace hullslam::internal
