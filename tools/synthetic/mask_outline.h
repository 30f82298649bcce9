// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam::synthetic {

// The outline of the visible part of one object.
struct InstanceOutline {
  int object = 0;                         // the value in the instance image
  int area = 0;                           // px, of the outlined component
  std::vector<Eigen::Vector2d> vertices;  // px, at least 3; the first is not repeated
};

// Outlines of the objects in an instance image (CV_16SC1, negative for the background), ordered by
// object. If something in front splits an object, only its largest part (4-connected) is outlined.
// Holes are filled, and parts smaller than `min_area` px are left out. The outline runs halfway
// between the centres of inside and outside pixels, so that it is not biased to either side. The
// centre of a pixel has integer coordinates.
std::vector<InstanceOutline> FindOutlines(const cv::Mat& instance, int min_area);

}  // namespace hullslam::synthetic
