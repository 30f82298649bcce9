// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// Measures how precisely landmarks fix the relative scale of two keyframes. For monocular maps.
// Where a camera turns in a door, for example, each landmark leaves the image before it has been
// seen from several positions in the next room. So few landmarks connect the scales of the two
// rooms.
//
// If two groups of keyframes both measure the depth of a landmark, the quotient of the two depths
// is a measurement of the ratio of their scales. Let s be the standard deviation of a ray
// (radians), and p_k^2 the sum of the squared deviations of the rays of group k from their mean
// (radians^2). The logarithm of a depth from group k has the variance s^2 / p_k^2, so the logarithm
// of the quotient has the variance
//   v = s^2 / p_1^2 + s^2 / p_2^2.
// The information of several landmarks is the sum of s^2 / v (radians^2).
class ScaleInformation {
 public:
  // `keyframes` are those of an island, by increasing id. They and the map must outlive this
  // object.
  ScaleInformation(const Map& map, const std::vector<KeyframeId>& keyframes);

  // The information about the relative scale of two keyframes, `older` < `newer` (indices). It is
  // the larger one of two estimates. The first uses the landmarks that both keyframes show; the two
  // groups are the keyframes up to the older one and those from the newer one on. The second adds
  // up variances from keyframe to keyframe; each keyframe belongs to the groups on both its sides,
  // and half of its variance counts for each side.
  double Between(size_t older, size_t newer) const;

 private:
  double Shared(KeyframeId older, KeyframeId newer) const;

  const Map& map_;
  const std::vector<KeyframeId>& keyframes_;
  std::vector<double> variances_;  // from the first keyframe to each keyframe, over s^2
};

}  // namespace hullslam
