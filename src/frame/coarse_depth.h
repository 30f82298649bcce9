// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// The depth image of a rectified pair, CV_32FC1, m, 0 where it is unknown; it has the size of the
// left image. It is found on images of half the size by semi-global matching (Hirschmüller 2008,
// in OpenCV), so details of few pixels are lost: it is for the surfaces of objects, whose keypoints
// are too few, and not for keypoints. Things nearer than four baselines are not found.
cv::Mat CoarseDepth(const cv::Mat& left, const cv::Mat& right, const PinholeCamera& camera);

}  // namespace hullslam
