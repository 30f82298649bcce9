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
#include "hullslam/geometry/packed_points.h"

namespace hullslam {

// One object seen in one frame. All pixel coordinates are undistorted.
struct Detection {
  std::string label;
  double score = 1.0;
  PackedPoints<2> contour;            // closed contour of the largest part of the mask, px
  std::vector<Eigen::Vector2d> hull;  // convex hull of all parts, positive signed area, px
  Eigen::AlignedBox2d box;            // bounding box of the hull, px
  // The primitive that the residuals are computed from; equal to DetectionOptions::primitive.
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;
  std::vector<SilhouetteLine> lines;  // the lines that constrain the quadric
  // Those of the same object in the right image of a stereo camera, px of that image; empty if its
  // mask is not known. Only residuals of lines use them.
  std::vector<SilhouetteLine> right_lines;
  std::optional<Ellipse> ellipse;  // least-squares fit of the contour for ellipse masks and
                                   // `conic`; the ellipse in the box for `box_ellipse`; else absent
  bool is_cut = false;             // the border of the image cuts the mask
  bool is_box = false;             // the mask is only a bounding box
  // Points of the depth image inside the eroded mask, m, camera frame; a few hundred at most.
  PackedPoints<3> points;
  std::vector<float> embedding;     // that of the mask (instance_mask.h); empty if there is none
  std::vector<uint32_t> keypoints;  // indices of the frame's keypoints inside the mask
};

}  // namespace hullslam
