// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

// The rules for removing keyframes and for making landmarks of pairs of keyframes
// (src/mapping/sensor_rules.h).
enum class MappingRule { kHullslam, kOrbSlam2 };

struct MappingOptions {
  int local_keyframes = 20;  // largest number of moving keyframes in local bundle adjustment
  // Largest number of fixed keyframes in local bundle adjustment; 0: all that observe its
  // landmarks.
  int fixed_keyframes = 0;
  bool cull_keyframes = true;
  int max_keyframes = 0;  // bound of the map (mapping/culling.h); 0: none
  MappingRule culling_rule = MappingRule::kHullslam;  // of keyframes
  MappingRule landmark_rule = MappingRule::kHullslam;
  bool final_bundle_adjustment = true;  // adjusts the whole map at the end of the run
  bool compact_keyframes = true;        // those far from the newest one (mapping/culling.h)

  void Bind(OptionTable& options);
};

}  // namespace hullslam
