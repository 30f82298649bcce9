// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/loop/loop_options.h"

namespace hullslam {

void LoopOptions::Bind(OptionTable& options) {
  options.Add("loop.closing", &enabled,
              "close loops when the camera comes back to a known place; needs a vocabulary");
  options.Add("loop.min_supporters", &min_supporters, Range::AtLeast(0),
              "if fewer neighbours of the query look like the candidate's place, twice as many "
              "landmarks are needed");
  options.Add("loop.min_matches", &min_matches, Range::AtLeast(4),
              "number of landmarks that must agree between query and candidate");
  options.Add("loop.min_landmarks", &min_landmarks, Range::AtLeast(4),
              "number of landmarks around the candidate that the query must find");
  options.Add("loop.drift_base", &drift_base, Range::AtLeast(0.0),
              "a loop may move the camera by this, m, and the following two");
  options.Add("loop.drift_per_metre", &drift_per_metre, Range::AtLeast(0.0),
              "m per metre travelled since the candidate");
  options.Add("loop.drift_per_radian", &drift_per_radian, Range::AtLeast(0.0),
              "m per radian turned since the candidate");
  options.Add("loop.turn_base", &turn_base, Range::AtLeast(0.0),
              "a loop may turn the camera by this, radians, and the following two");
  options.Add("loop.turn_per_metre", &turn_per_metre, Range::AtLeast(0.0),
              "radians per metre travelled since the candidate");
  options.Add("loop.turn_per_radian", &turn_per_radian, Range::AtLeast(0.0),
              "radians per radian turned since the candidate");
  options.Add("loop.global_adjustment", &global_adjustment,
              "adjust the whole map after a loop was closed");
}

}  // namespace hullslam
