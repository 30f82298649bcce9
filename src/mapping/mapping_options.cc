// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/mapping/mapping_options.h"

namespace hullslam {

void MappingOptions::Bind(OptionTable& options) {
  options.Add("mapping.local_keyframes", &local_keyframes, Range::AtLeast(2),
              "largest number of keyframes that local bundle adjustment moves");
  options.Add("mapping.fixed_keyframes", &fixed_keyframes, Range::AtLeast(0),
              "largest number of fixed keyframes in local bundle adjustment; 0: all that observe "
              "its landmarks");
  options.Add("mapping.cull_keyframes", &cull_keyframes, "remove redundant keyframes");
  options.Add("mapping.compact_keyframes", &compact_keyframes,
              "remove keypoints that show no landmark from keyframes far from the newest one");
  options.Add("mapping.final_bundle_adjustment", &final_bundle_adjustment,
              "run a global bundle adjustment once at the end of the run");
}

}  // namespace hullslam
