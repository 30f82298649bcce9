// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/mapping/mapping_options.h"

namespace hullslam {

void MappingOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "mapping");
  scope.Add("local_keyframes", &local_keyframes, Range::AtLeast(2),
            "largest number of keyframes that local bundle adjustment moves");
  scope.Add("fixed_keyframes", &fixed_keyframes, Range::AtLeast(0),
            "largest number of fixed keyframes in local bundle adjustment; 0: all that observe "
            "its landmarks");
  scope.Add("cull_keyframes", &cull_keyframes, "remove redundant keyframes");
  scope.Add("compact_keyframes", &compact_keyframes,
            "remove keypoints that show no landmark from keyframes far from the newest one");
  scope.Add("final_bundle_adjustment", &final_bundle_adjustment,
            "run a global bundle adjustment once at the end of the run");
}

}  // namespace hullslam
