// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hullslam {

// Keypoints this near to a mask count as in it, px: corners at a silhouette are half background,
// and masks tend to be too small.
inline constexpr int kMaskMarginPx = 7;

// What an outline is: that of a mask, or all that is known of a box or an ellipse.
enum class MaskShape { kContour, kBox, kEllipse };

// One instance that a detector or segmenter found in an image, in **raw** (distorted) pixels;
// pixel centres have integer coordinates.
struct InstanceMask {
  std::string label;   // the class's name, as "cup"
  double score = 1.0;  // confidence, 0 to 1
  MaskShape shape = MaskShape::kContour;
  // Closed outlines without holes, one a connected part, the largest first; three points or more
  // each. For a box: one outline, its four corners. For an ellipse: one, 64 points on it.
  std::vector<std::vector<Eigen::Vector2d>> outlines;
};

}  // namespace hullslam
