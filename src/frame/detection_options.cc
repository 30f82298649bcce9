// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/detection_options.h"

namespace hullslam {

void DetectionOptions::Bind(OptionTable& options) {
  options.AddEnum("objects.primitive", &primitive, ObjectPrimitiveNames(),
                  "what the lines of a detection are made from");
  options.Add("objects.epsilon_px", &epsilon_px, Range::Between(0.0, 100.0),
              "tolerance for simplifying the hull or contour, px");
  options.Add("objects.uniform_directions", &uniform_directions, Range::Between(0, 64),
              "number of evenly spread directions of support lines, in addition to those of the "
              "edges of the hull");
  options.Add("objects.min_line_px", &min_line_px, Range::Between(0.0, 1000.0),
              "shorter edges give no line, px");
  options.Add("objects.min_line_angle", &min_line_angle, Range::Between(0.0, 1.5),
              "least angle between the directions of two support lines, radians");
  options.Add("objects.conic_lines", &conic_lines, Range::Between(3, 1000),
              "number of lines of a mask if objects.primitive is conic or the mask is an ellipse");
  options.Add("objects.min_part_share", &min_part_share, Range::Between(0.0, 1.0),
              "smaller parts of a mask are left out, as a share of the area of the largest part");
  options.Add("objects.border_px", &border_px, Range::Between(0.0, 1000.0),
              "a line that touches its mask only within this distance of the border of the image "
              "is one-sided, px");
  options.Add("objects.min_score", &min_score, Range::Between(0.0, 1.0),
              "masks with a lower score are rejected");
  options.Add("objects.min_side_px", &min_side_px, Range::Between(0.0, 10000.0),
              "masks with a smaller width or height are rejected, px");
  options.Add("objects.max_area_share", &max_area_share, Range::Between(0.0, 1.0),
              "masks whose hull covers a larger share of the image are rejected");
  options.Add("objects.min_keypoints", &min_keypoints, Range::Between(0, 10000),
              "masks that contain fewer keypoints are rejected");
  options.Add("objects.duplicate_iou", &duplicate_iou, Range::Between(0.1, 1.0),
              "two masks of a frame with at least this IoU are the same object");
  options.Add("objects.duplicate_class_iou", &duplicate_class_iou, Range::Between(0.1, 1.0),
              "two outlines of one class with at least this IoU are the same object, if the depth "
              "of either is not known");
  options.Add("objects.fragment_inside", &fragment_inside, Range::Between(0.0, 1.0),
              "a mask may be a fragment of another mask if at least this share of it lies inside");
  options.Add("objects.fragment_area", &fragment_area, Range::Between(0.0, 1.0),
              "least area of a fragment, as a share of the area of the other mask");
  options.Add("objects.fragment_depth", &fragment_depth, Range::Between(0.0, 10.0),
              "largest relative difference between the depths of a fragment and the other mask");
  options.Add("objects.occlusion_step", &occlusion_step, Range::Between(0.0, 100.0),
              "something that is nearer than an object by less than this does not hide it, m");
  options.Add("objects.occlusion_step_share", &occlusion_step_share, Range::Between(0.0, 1.0),
              "something that is nearer than an object by less than this does not hide it, as a "
              "share of its depth");
  options.Add("objects.max_depth_points", &max_depth_points, Range::Between(1, 10000),
              "approximate largest number of depth points per mask");
  options.Add("objects.max_depth_offset", &max_depth_offset, Range::Between(0.0, 1000.0),
              "depth points farther than this from the median depth of their mask are left out, as "
              "a share of the larger side of the mask at that depth");
}

}  // namespace hullslam
