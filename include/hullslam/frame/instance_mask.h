// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hullslam {

// Keypoints this near to a mask count as in it, px. The patch of a corner at a silhouette is half
// background, and masks tend to be too small.
inline constexpr int kMaskMarginPx = 7;

// What the outlines of an instance are: those of a mask, or only a bounding box or an ellipse.
enum class MaskShape { kContour, kBox, kEllipse };

// One instance that a detector or segmenter found in an image, in **raw** (distorted) pixels. Pixel
// centres have integer coordinates.
struct InstanceMask {
  std::string label;   // name of the class, such as "cup"
  double score = 1.0;  // confidence, 0 to 1
  MaskShape shape = MaskShape::kContour;
  // Closed outlines without holes, one per connected part, the largest first. Each has at least
  // three points. A box has one outline with its four corners; an ellipse has one with 64 points.
  std::vector<std::vector<Eigen::Vector2d>> outlines;
};

}  // namespace hullslam
