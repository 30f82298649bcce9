// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/tracking/tracking_options.h"

namespace hullslam {

void TrackingOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "tracking");
  scope.Add("min_initial_points", &min_initial_points, Range::AtLeast(10),
            "number of keypoints with depth that the first frame needs");
  scope.Add("min_inliers", &min_inliers, Range::AtLeast(6),
            "number of landmarks that must be found in a frame; with fewer it is lost");
  scope.Add("local_keyframes", &local_keyframes, Range::AtLeast(1),
            "largest number of keyframes whose landmarks form the local map");
  scope.Add(
      "keyframe_ratio", &keyframe_ratio, Range::Between(0.1, 1.0),
      "a keyframe is due if a frame finds a smaller share of the reference keyframe's landmarks");
  scope.AddText(
      "dynamic_classes", &dynamic_classes,
      "classes of dynamic objects, separated by commas; keypoints on their masks are removed");
  scope.Add("keyframe_interval", &keyframe_interval, Range::Between(0.0, 60.0),
            "least time between keyframes, unless tracking weakens abruptly, s");
  scope.Add("relocalise_by_words", &relocalise_by_words,
            "find a lost frame by keyframes that look like it (needs a vocabulary)");
  scope.Add("relocalise_by_objects", &relocalise_by_objects,
            "find a lost frame by the arrangement of the mapped objects in it (needs masks)");
}

}  // namespace hullslam
