// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/util/option_table.h"

namespace hullslam {

struct TrackingOptions {
  int min_initial_points = 50;  // keypoints with depth in the first frame
  int min_inliers = 30;         // landmarks that must be found; with fewer a frame is lost
  int local_keyframes = 80;     // largest number of keyframes in the local map

  // A keyframe is due if a frame finds a smaller share of the reference keyframe's landmarks.
  double keyframe_ratio = 0.95;

  double keyframe_interval =
      0.2;  // s, least time between keyframes, unless tracking weakens abruptly

  // Dynamic classes, separated by commas. Keypoints on their masks are removed; they are not
  // mapped.
  std::string dynamic_classes = "person";

  // The methods that find a lost frame in the map. Words need a vocabulary, objects need masks.
  bool relocalise_by_words = true;
  bool relocalise_by_objects = true;

  void Bind(OptionTable& options);
};

}  // namespace hullslam
