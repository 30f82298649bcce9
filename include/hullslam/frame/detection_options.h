// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/object_primitive.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// How masks become detections and their lines.
struct DetectionOptions {
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;  // which lines constrain the quadrics
  double epsilon_px = 3.0;       // simplification of the hull or contour (Douglas-Peucker)
  int uniform_directions = 8;    // of support lines, besides the edges of the simplified hull
  double min_line_px = 5.0;      // shorter edges give no line
  double min_line_angle = 0.09;  // radians between two support lines
  int conic_lines = 16;          // tangents of an ellipse
  double min_part_share = 0.1;  // smaller parts of a mask, of the area of the largest, are left out
  double border_px = 5.0;       // nearer to the border of the raw image than this is cut by it

  // Masks beyond these are not used.
  double min_score = 0.0;
  double min_side_px = 10.0;    // of the box around the hull
  double max_area_share = 0.5;  // of the image, area of the hull
  int min_keypoints = 0;        // inside
  double duplicate_iou = 0.6;   // of the masks: at least this much are one object
  // Of two masks the smaller one may also be a fragment of the larger: nearly all of it lies
  // inside, it is not much smaller (else it is a thing of its own in front, as a cup before a
  // monitor), and it is as far away.
  double fragment_inside = 0.85;  // share of the smaller mask in the larger
  double fragment_area = 0.4;     // area of the smaller mask over that of the larger
  double fragment_depth = 0.05;   // largest relative difference of the median depths
  int max_depth_points = 200;     // taken of a mask, about
  // What is nearer than an object by more than both hides it. The first is in metres: it is the
  // noise of a depth camera, and without depth images it is not used.
  double occlusion_step = 0.03;        // m
  double occlusion_step_share = 0.04;  // of the depth

  // Binds the keys `objects.primitive`, `objects.epsilon_px` ...
  void Bind(OptionTable& options);
};

}  // namespace hullslam
