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
  scope.AddEnum("keyframe_rule", &keyframe_rule, {"hullslam", "orb_slam2"},
                "when a frame becomes a keyframe: evenly in time, or by the rule of ORB-SLAM2");
  scope.Add("keyframes_for_objects", &keyframes_for_objects,
            "objects that are not mapped yet are a reason for a keyframe (rule hullslam only)");
  scope.AddText(
      "dynamic_classes", &dynamic_classes,
      "classes of dynamic objects, separated by commas; they are not mapped, and keypoints on "
      "their masks are removed");
  scope.Add("remove_dynamic", &remove_dynamic,
            "remove the keypoints on the masks of dynamic classes");
  scope.Add("keyframe_interval", &keyframe_interval, Range::Between(0.0, 60.0),
            "least time between keyframes, unless tracking weakens abruptly, s; in the rule "
            "orb_slam2 the time in which the mapper is busy with a keyframe");
  scope.Add("wide_search", &wide_search,
            "search windows grow with the width of the image and, if needed, up to the expected "
            "motion; if not, they double once");
  scope.Add(
      "wide_matches", &wide_matches,
      "a lost frame is also sought by matches without words or a prediction, as in recordings "
      "whose "
      "images are far apart (without depth, two pairs of images must agree with its rotation); at "
      "the end, lost frames and parts of the map are joined in the same way");
  scope.Add("begin_islands", &begin_islands,
            "a camera that stays lost begins a new part of the map; if not, only while the map has "
            "at most five keyframes");
  scope.Add("refine_at_end", &refine_at_end,
            "compute the poses of frames again at the end of the run, from the landmarks and "
            "objects that were found in them");
  scope.Add("locate_at_end", &locate_at_end,
            "look for early and lost frames in the map at the end of the run");
  scope.Add("correct_shutter", &correct_shutter,
            "correct the rolling shutter that Camera.readout_time describes; if not, the readout "
            "time counts as 0");
  scope.Add("relocalise_by_words", &relocalise_by_words,
            "find a lost frame by keyframes that look like it (needs a vocabulary)");
  scope.Add("relocalise_by_objects", &relocalise_by_objects,
            "find a lost frame by the arrangement of the mapped objects in it (needs masks)");
}

}  // namespace hullslam
