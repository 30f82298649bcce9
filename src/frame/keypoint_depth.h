// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

#include "hullslam/camera/depth.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

// The depth (m) of the surface that a keypoint shows; 0 if it is unknown or if the keypoint is at
// the border of a surface. `bf` is that of the camera, and `scale` is that of the keypoint's level.
//
// A corner is found where the pixels on a circle around it are brighter or darker than it. So its
// centre may be 3 px of its level away from the border that it moves with, on another surface. Such
// a depth is wrong in every view of the keypoint, so its error does not average out, and the map
// gets a wrong scale. The disparity of a plane is linear in the image, so at two opposite points of
// the circle its mean is that at the centre. The keypoint is at a border where one of these means
// differs by more than the noise of depth explains. Opposite points of which one is unknown are not
// compared. With DepthErrorModel::kRightColumn, as of ORB-SLAM2, borders have a depth too.
float KeypointDepth(const cv::Mat& depth, const RawKeypoint& keypoint, double scale, double bf,
                    const DepthOptions& options);

}  // namespace hullslam
