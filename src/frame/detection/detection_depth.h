// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "frame/detection/detection_lines.h"
#include "frame/detection/mask_camera.h"
#include "frame/detection/mask_region.h"

namespace hullslam {

// A depth image with the view in which a mask is described.
struct MaskDepth {
  MaskCamera camera;
  const cv::Mat& image;  // as in ImageInput, or empty
  double units_per_metre;

  // Depth at a raw pixel, m; 0 if it is unknown.
  double AtRaw(const Eigen::Vector2d& raw) const;
};

// Points of the mask in the camera frame, m, about `max_points` at most. They are on a regular grid
// of raw pixels. Pixels near the border of the mask are left out, because their depth may be that
// of the background.
std::vector<Eigen::Vector3d> DepthPoints(const MaskDepth& view, const MaskRegion& region,
                                         int max_points);

// Median of z; 0 if there are no points.
double MedianDepth(std::span<const Eigen::Vector3d> points);

// Removes the points whose depth in the view differs from the median by more than `max_offset`
// times the size that `side` (px) has at the median depth.
void RemoveFarFromMedian(const MaskCamera& camera, double side, double max_offset,
                         std::vector<Eigen::Vector3d>& points);

// Whether something nearer than the object begins just beyond the line. This is tested at several
// points along the line, with the depth image. Where it has no depth, the nearest known depth of
// the mask there is used (`others`: the frame's other masks). The condition must hold at half or
// more of the points with known depths.
bool IsHidden(const LineOnOutline& line, const MaskDepth& view, double object_depth,
              std::span<const MaskRegion* const> others, const DetectionOptions& options);

}  // namespace hullslam
