// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/frame/object_primitive.h"
#include "hullslam/geometry/conic.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// One object seen in one frame; undistorted pixels throughout.
struct Detection {
  std::string label;
  double score = 1.0;
  std::vector<Eigen::Vector2d> contour;  // closed, px; the largest part of the mask
  std::vector<Eigen::Vector2d> hull;     // of all parts; convex, positive signed area, px
  Eigen::AlignedBox2d box;               // of the hull, px
  // What its residuals are computed from, as DetectionOptions::primitive asks for.
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;
  std::vector<SilhouetteLine> lines;  // constrain the quadric
  std::optional<Ellipse> ellipse;     // least-squares fit of the contour, where asked for
  bool is_cut = false;                // by the border of the image
  bool is_box = false;                // nothing but a box is known
  // Points of the depth image inside the eroded mask, m, camera frame; a few hundred at most.
  std::vector<Eigen::Vector3d> points;
  std::vector<uint32_t> keypoints;  // indices of the frame's keypoints inside the contour
};

}  // namespace hullslam
