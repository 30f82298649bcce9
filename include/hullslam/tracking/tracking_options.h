// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/util/option_table.h"

namespace hullslam {

// The rules for making a frame a keyframe. kHullslam: keyframes are spread evenly in time
// (src/tracking/keyframe_policy.h); kOrbSlam2: src/tracking/comparison/orb_slam2_keyframe_rule.h.
enum class KeyframeRule { kHullslam, kOrbSlam2 };

struct TrackingOptions {
  int min_initial_points = 50;  // keypoints with depth in the first frame
  int min_inliers = 30;         // landmarks that must be found; with fewer a frame is lost
  int local_keyframes = 80;     // largest number of keyframes in the local map

  KeyframeRule keyframe_rule = KeyframeRule::kHullslam;
  // A keyframe is due if a frame finds a smaller share of the reference keyframe's landmarks. Only
  // for the rule kHullslam.
  double keyframe_ratio = 0.95;

  double keyframe_interval =
      0.2;  // s, least time between keyframes, unless tracking weakens abruptly
  // Whether detections that show no mapped object are a reason for a keyframe. Only for the rule
  // kHullslam.
  bool keyframes_for_objects = true;
  // Whether the windows in which landmarks are searched grow with the width of the image and, if
  // needed, up to the motion that is expected. Otherwise they double once if needed.
  bool wide_search = true;
  // Whether a camera with depth that is lost is also sought by matches without words or a
  // prediction, as in recordings whose images are far apart; at the end, lost frames become
  // keyframes, and parts of the map are joined in the same way. Not while only localising.
  bool wide_matches = true;
  // Whether a camera that stays lost begins a new island. Otherwise only one that is lost in a map
  // of at most five keyframes does.
  bool begin_islands = true;
  // Whether frames get new poses at the end of the run, from the landmarks that were found in them.
  bool refine_at_end = true;
  // Whether frames before a monocular map, those tracked in its first keyframes and lost ones are
  // sought in the final map.
  bool locate_at_end = true;

  // Correct the rolling shutter of a camera with a readout time. Otherwise each image counts as
  // exposed at once.
  bool correct_shutter = true;

  // Dynamic classes, separated by commas. They are not mapped, and keypoints on their masks are
  // removed if remove_dynamic is set.
  std::string dynamic_classes = "person";
  bool remove_dynamic = true;

  // The methods that find a lost frame in the map. Words need a vocabulary, objects need masks.
  bool relocalise_by_words = true;
  bool relocalise_by_objects = true;

  void Bind(OptionTable& options);
};

}  // namespace hullslam
