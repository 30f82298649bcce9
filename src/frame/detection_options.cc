// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/detection_options.h"

namespace hullslam {

void DetectionOptions::Bind(OptionTable& options) {
  options.AddEnum("objects.primitive", &primitive, ObjectPrimitiveNames(),
                  "what of a mask holds its quadric");
  options.Add("objects.epsilon_px", &epsilon_px, Range::Between(0.0, 100.0),
              "tolerance of the simplified hull or contour, px");
  options.Add("objects.uniform_directions", &uniform_directions, Range::Between(0, 64),
              "support lines in evenly spread directions, besides those of the hull's edges");
  options.Add("objects.min_line_px", &min_line_px, Range::Between(0.0, 1000.0),
              "edges shorter than this give no line, px");
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
  options.Add("objects.max_depth_points", &max_depth_points, Range::Between(1, 10000),
              "depth points taken of a mask, about, at most");
}

}  // namespace hullslam
