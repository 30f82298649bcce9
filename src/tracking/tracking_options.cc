// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/tracking/tracking_options.h"

namespace hullslam {

void TrackingOptions::Bind(OptionTable& options) {
  options.Add("tracking.min_initial_points", &min_initial_points, Range::AtLeast(10),
              "keypoints with depth that the first frame needs");
  options.Add("tracking.min_inliers", &min_inliers, Range::AtLeast(6),
              "landmarks that must be found in a frame, else it counts as lost");
  options.Add("tracking.local_keyframes", &local_keyframes, Range::AtLeast(1),
              "keyframes against whose landmarks a frame is tracked, at most");
  options.Add("tracking.keyframe_ratio", &keyframe_ratio, Range::Between(0.1, 1.0),
              "share of the reference keyframe's landmarks below which a keyframe is due");
  options.AddText("tracking.dynamic_classes", &dynamic_classes,
                  "classes of masks to take keypoints out, separated by commas");
  options.Add("tracking.keyframe_interval", &keyframe_interval, Range::Between(0.0, 60.0),
              "least time between keyframes unless tracking weakens abruptly, s");
}

}  // namespace hullslam
