// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace hullslam {

// Keypoints that are this near to a mask count as inside it, px. Half of the patch of a corner at a
// silhouette shows the background, and masks tend to be too small.
inline constexpr int kMaskMarginPx = 7;

// The origin of the outlines of an instance: a mask, or only a bounding box or an ellipse.
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
  // The appearance of the object, a vector of any network (CLIP or the like), of which only the
  // direction counts; all of a run have the same number of elements. Empty if there is none.
  std::vector<float> embedding = {};
};

// Throws InputError for a mask without a label, a score that is not between 0 and 1, an outline of
// fewer than three or more than 100 000 points, a point that is not finite or farther outside the
// image (width x height px) than that is wide or high, outlines that would take seconds to fill,
// shares of the image (0 to 1) instead of pixels in all masks, and an embedding without a direction
// (zero or not finite). The message has the number of the mask and the reason.
void ValidateMasks(std::span<const InstanceMask> masks, int width, int height);

}  // namespace hullslam
