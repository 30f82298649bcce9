// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

#include "hullslam/frame/frame.h"

namespace hullslam {

inline constexpr int kWall = 2000;  // mm

// What a camera sees that looks straight at a wall.
inline Frame WallFrame(int millimetres = kWall) {
  Frame frame;
  frame.depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(millimetres)), 1000.0);
  return frame;
}

}  // namespace hullslam
