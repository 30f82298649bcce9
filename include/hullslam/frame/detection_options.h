// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/object_primitive.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// How masks are turned into detections.
struct DetectionOptions {
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;  // which lines constrain the quadrics
  double epsilon_px = 3.0;     // simplification of the hull or contour (Douglas-Peucker)
  int uniform_directions = 8;  // of support lines, besides the edges of the simplified hull
  double min_line_px = 5.0;    // shorter edges give no line
  double border_px = 5.0;      // nearer to the border of the raw image than this is cut by it

  // Masks beyond these are not used.
  double min_score = 0.0;
  double min_side_px = 10.0;    // of the box around the hull
  double max_area_share = 0.5;  // of the image, area of the hull
  int min_keypoints = 0;        // inside
  double duplicate_iou = 0.6;   // of the masks: at least this much are one object
  int max_depth_points = 200;   // taken of a mask, about

  // Binds the keys `objects.primitive`, `objects.epsilon_px` ...
  void Bind(OptionTable& options);
};

}  // namespace hullslam
