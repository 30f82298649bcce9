// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/object_primitive.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// The options for making detections and their lines from instance masks.
struct DetectionOptions {
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;  // the lines are made from this
  double epsilon_px = 3.0;       // tolerance for simplifying hull or contour (Douglas-Peucker)
  int uniform_directions = 8;    // number of support lines, in addition to the edges of the hull
  double min_line_px = 5.0;      // length; shorter edges give no line
  double min_line_angle = 0.09;  // radians, least angle between two support lines
  int conic_lines = 16;          // number of tangents of an ellipse
  double min_part_share = 0.1;   // least area of a part of a mask over that of the largest part
  double border_px = 5.0;        // a point is cut if it is this near to the border of the raw image

  // A mask that does not satisfy these conditions is rejected.
  double min_score = 0.0;
  double min_side_px = 10.0;    // least width and height of the bounding box of the hull
  double min_area_px2 = 0.0;    // least area of the hull, px^2
  double max_area_share = 0.5;  // largest area of the hull, as a share of the image
  int min_keypoints = 0;        // inside the mask
  double duplicate_iou = 0.6;   // masks with at least this IoU show the same object
  // Two masks of one class show the same object already at this IoU if the depth of at least one of
  // them is not known. A network often segments one thing twice, for example a book, and the book
  // with the paper under it.
  double duplicate_class_iou = 0.25;
  // Two masks also show the same object if the smaller one is a fragment of the larger one. A
  // fragment lies almost completely inside the larger mask, is not much smaller, and has nearly the
  // same depth. A much smaller mask is another object in front, such as a cup in front of a
  // monitor.
  double fragment_inside = 0.85;  // least share of the smaller mask that is inside the larger
  double fragment_area = 0.4;     // least area of the smaller mask over that of the larger
  double fragment_depth = 0.05;   // largest relative difference of the median depths
  int max_depth_points = 200;     // per mask, approximately
  // Depth points farther than this from the median depth of the mask are left out, because they
  // show the background. The number is a share of the larger side of the mask, in metres at the
  // median depth.
  double max_depth_offset = 0.75;
  // Something hides an object if it is nearer by more than both steps. The first step is the noise
  // of a depth camera. Both steps are used only with depth images.
  double occlusion_step = 0.03;        // m
  double occlusion_step_share = 0.04;  // share of the object's depth

  void Bind(const OptionScope& scope);
};

}  // namespace hullslam
