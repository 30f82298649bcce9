// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/detection_options.h"

namespace hullslam {

void DetectionOptions::Bind(OptionTable& options) {
  options.AddEnum("objects.primitive", &primitive, ObjectPrimitiveNames(),
                  "what of a mask constrains its quadric");
  options.Add("objects.epsilon_px", &epsilon_px, Range::Between(0.0, 100.0),
              "tolerance of the simplified hull or contour, px");
  options.Add("objects.uniform_directions", &uniform_directions, Range::Between(0, 64),
              "support lines in evenly spread directions, besides those of the hull's edges");
  options.Add("objects.min_line_px", &min_line_px, Range::Between(0.0, 1000.0),
              "edges shorter than this give no line, px");
  options.Add("objects.min_line_angle", &min_line_angle, Range::Between(0.0, 1.5),
              "angle between the directions of two support lines, at least, radians");
  options.Add("objects.conic_lines", &conic_lines, Range::Between(3, 1000),
              "lines of a mask for objects.primitive conic, and of masks that are ellipses");
  options.Add("objects.min_part_share", &min_part_share, Range::Between(0.0, 1.0),
              "parts of a mask smaller than this are left out, as a share of the largest");
  options.Add("objects.border_px", &border_px, Range::Between(0.0, 1000.0),
              "sides of a mask this near to the border of the image are cut by it, px");
  options.Add("objects.min_score", &min_score, Range::Between(0.0, 1.0),
              "masks of a lower confidence are not used");
  options.Add("objects.min_side_px", &min_side_px, Range::Between(0.0, 10000.0),
              "masks narrower or lower than this are not used, px");
  options.Add("objects.max_area_share", &max_area_share, Range::Between(0.0, 1.0),
              "masks whose hull fills a larger share of the image are not used");
  options.Add("objects.min_keypoints", &min_keypoints, Range::Between(0, 10000),
              "masks with fewer keypoints in them are not used");
  options.Add("objects.duplicate_iou", &duplicate_iou, Range::Between(0.1, 1.0),
              "masks of a frame that overlap this much (IoU) are one object");
  options.Add("objects.fragment_inside", &fragment_inside, Range::Between(0.0, 1.0),
              "share of a mask inside another from which on it may be a fragment of it");
  options.Add("objects.fragment_area", &fragment_area, Range::Between(0.0, 1.0),
              "area of a fragment over that of the other mask, at least");
  options.Add("objects.fragment_depth", &fragment_depth, Range::Between(0.0, 10.0),
              "relative difference of the depths of a fragment and the other mask, at most");
  options.Add("objects.occlusion_step", &occlusion_step, Range::Between(0.0, 100.0),
              "what is nearer than an object by less than this does not hide it, m");
  options.Add("objects.occlusion_step_share", &occlusion_step_share, Range::Between(0.0, 1.0),
              "the same as a share of the depth");
  options.Add("objects.max_depth_points", &max_depth_points, Range::Between(1, 10000),
              "depth points taken of a mask, about, at most");
}

}  // namespace hullslam
