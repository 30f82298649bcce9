// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

struct MappingOptions {
  int local_keyframes = 20;  // largest number of moving keyframes in local bundle adjustment
  // Largest number of fixed keyframes in local bundle adjustment; 0: all that observe its
  // landmarks.
  int fixed_keyframes = 0;
  bool cull_keyframes = true;
  bool final_bundle_adjustment = true;  // adjusts the whole map at the end of the run
  bool compact_keyframes = true;        // those far from the newest one (mapping/old_keyframes.h)

  void Bind(OptionTable& options);
};

}  // namespace hullslam
