// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/util/option_table.h"

namespace hullslam {

struct TrackingOptions {
  int min_initial_points = 50;  // keypoints with depth in the first frame
  int min_inliers = 30;         // landmarks found, else a frame counts as lost
  int local_keyframes = 80;     // against whose landmarks a frame is tracked

  // A keyframe is due when a frame finds fewer of the reference keyframe's landmarks than this
  // share.
  double keyframe_ratio = 0.95;

  double keyframe_interval = 0.2;  // s, least time between keyframes unless tracking gets weak fast

  // Classes, separated by commas, whose masks hide keypoints and are no objects.
  std::string dynamic_classes = "person";

  void Bind(OptionTable& options);
};

}  // namespace hullslam
