// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace hullslam {

// Whether the patch around `center` is a straight edge, along which nothing tells its position. The
// patch must be inside `image` (CV_8UC1): 4 px on each side of the centre.
//
// The covariance of the position of a patch is the noise of the grey levels times the inverse of
// the structure tensor, the sum over the patch of g g^T with the gradients g (Foerstner and Guelch
// 1987). If the larger eigenvalue of the tensor is r times the smaller one, the position along the
// edge is sqrt(r) times less precise than across it. Across it, corners are precise to 0.6 px
// (freiburg1_xyz, docs/monocular.md). With r = 16 that is 2.4 px along the edge, and this is the
// bound of an inlier: the root of 5.99 sigma^2 with the assumed sigma of 1 px. So a landmark on
// such an edge agrees with many wrong matches: the same edge has other corners nearby, which look
// alike.
bool IsStraightEdge(const cv::Mat& image, cv::Point center);

}  // namespace hullslam
