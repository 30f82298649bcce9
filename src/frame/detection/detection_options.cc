// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/detection_options.h"

namespace hullslam {

void DetectionOptions::Bind(const OptionScope& scope) {
  scope.AddEnum("primitive", &primitive, ObjectPrimitiveNames(),
                "what the lines of a detection are made from");
  scope.Add("epsilon_px", &epsilon_px, Range::Between(0.0, 100.0),
            "tolerance for simplifying the hull or contour, px");
  scope.Add("uniform_directions", &uniform_directions, Range::Between(0, 64),
            "number of evenly spread directions of support lines, in addition to those of the "
            "edges of the hull");
  scope.Add("border_px", &border_px, Range::Between(0.0, 1000.0),
            "a line that touches its mask only within this distance of the border of the image is "
            "one-sided, px");
  scope.Add("min_score", &min_score, Range::Share(), "masks with a lower score are rejected");
  scope.Add("min_side_px", &min_side_px, Range::Between(0.0, 10000.0),
            "masks with a smaller width or height are rejected, px");
  scope.Add("min_area_px2", &min_area_px2, Range::Between(0.0, 1e8),
            "masks whose hull has a smaller area are rejected, px^2");
  scope.Add("max_area_share", &max_area_share, Range::Share(),
            "masks whose hull covers a larger share of the image are rejected");
  scope.Add("min_keypoints", &min_keypoints, Range::Between(0, 10000),
            "masks that contain fewer keypoints are rejected");
  scope.Add("duplicate_iou", &duplicate_iou, Range::Between(0.1, 1.0),
            "two masks of a frame with at least this IoU are the same object");
  scope.Add("duplicate_class_iou", &duplicate_class_iou, Range::Between(0.1, 1.0),
            "two outlines of one class with at least this IoU are the same object, if the depth of "
            "either is not known");
  scope.Add("max_depth_offset", &max_depth_offset, Range::Between(0.0, 1000.0),
            "depth points farther than this from the median depth of their mask are left out, as a "
            "share of the larger side of the mask at that depth");
  scope.Add("occlusion_step", &occlusion_step, Range::Between(0.0, 100.0),
            "something that is nearer than an object by less than this does not hide it, m");
  scope.Add("occlusion_step_share", &occlusion_step_share, Range::Share(),
            "something that is nearer than an object by less than this does not hide it, as a "
            "share of its depth");
}

}  // namespace hullslam
