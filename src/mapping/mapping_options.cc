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
  scope.Add("max_keyframes", &max_keyframes, Range::AtLeast(0),
            "largest number of keyframes in the map; 0: no bound. Those go first of which others "
            "see most, none that connects places or that an object needs");
  scope.AddEnum("culling_rule", &culling_rule, {"hullslam", "orb_slam2"},
                "which keyframes are redundant: also observations of objects, far landmarks and "
                "directions count, or the rule of ORB-SLAM2");
  scope.AddEnum(
      "landmark_rule", &landmark_rule, {"hullslam", "orb_slam2"},
      "which keypoints become landmarks: all with depth and pairs whose expected parallax "
      "is large enough, or those that are near or whose own parallax is large enough, as "
      "in ORB-SLAM2");
  scope.Add("compact_keyframes", &compact_keyframes,
            "remove keypoints that show no landmark from keyframes far from the newest one");
  scope.Add("final_bundle_adjustment", &final_bundle_adjustment,
            "run a global bundle adjustment once at the end of the run");
}

}  // namespace hullslam
