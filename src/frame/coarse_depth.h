// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "hullslam/camera/pinhole.h"
#include "util/task_runner.h"

namespace hullslam {

// The place of a left image where depths are wanted.
struct CoarseDepthPlace {
  cv::Rect region;                     // px, inside the image
  std::span<const float> disparities;  // of keypoints in the whole image, px; 0 where unknown
};

// The depth image of a rectified pair, CV_32FC1, m, 0 where it is unknown and outside of the
// region; it has the size of the left image. It is found on smaller images by semi-global
// matching (Hirschmüller 2008, in OpenCV), so details of few pixels are lost: it is for the
// surfaces of objects, whose keypoints are too few, and not for keypoints. The disparities of the
// keypoints say how near things are. Things nearer than four baselines are not found.
cv::Mat CoarseDepth(const cv::Mat& left, const cv::Mat& right, const PinholeCamera& camera,
                    const CoarseDepthPlace& place, TaskRunner& runner);

}  // namespace hullslam
