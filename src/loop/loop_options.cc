// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/loop/loop_options.h"

namespace hullslam {

void LoopOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "loop");
  scope.Add("closing", &enabled,
            "close loops when the camera comes back to a known place; needs a vocabulary");
  scope.Add("min_matches", &min_matches, Range::AtLeast(4),
            "number of landmarks that must agree between query and candidate");
  scope.Add("min_landmarks", &min_landmarks, Range::AtLeast(4),
            "number of landmarks around the candidate that the query must find");
  scope.Add("min_supporters", &min_supporters, Range::AtLeast(0),
            "if fewer neighbours of the query look like the candidate's place, twice as many "
            "landmarks are needed");
  scope.Add("drift_base", &drift_base, Range::AtLeast(0.0),
            "a loop may always move the camera by this, m; without depth, the median depth of the "
            "scene counts as a metre");
  scope.Add("turn_base", &turn_base, Range::AtLeast(0.0),
            "a loop may always turn the camera by this, radians");
  scope.Add("object_votes", &object_votes,
            "mapped objects at both ends speak for or against a loop");
  scope.Add("global_adjustment", &global_adjustment,
            "adjust the whole map after a loop was closed");
}

}  // namespace hullslam
