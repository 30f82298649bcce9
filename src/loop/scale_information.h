// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// How well the landmarks of a map without depth tell the scale around one keyframe by that around
// another. Where a camera turns in a door, all that it sees leaves the image before it was seen
// from several places on the other side. The scales of the two rooms hardly depend on each other
// there.
//
// A landmark tells the ratio of the scales of two groups of keyframes by the depths that both
// measure. With p^2, the sum of the squared deviations of the rays of a group from their mean
// (radians^2), and the standard deviation s of a ray, the variance of its logarithm is
// s^2 / p_1^2 + s^2 / p_2^2. The information of landmarks is the sum of s^2 / variance, radians^2.
class ScaleInformation {
 public:
  // `keyframes`: those of an island, by increasing id. It and the map must outlive this object.
  ScaleInformation(const Map& map, const std::vector<KeyframeId>& keyframes);

  // Between two of them, `older` < `newer` (indices). The better one of two ways: by the landmarks
  // that both show, with the groups of keyframes up to the older one and from the newer one on; and
  // from keyframe to keyframe, where each is in the groups of both its sides and half of its
  // variance counts on each side.
  double Between(size_t older, size_t newer) const;

 private:
  double Shared(KeyframeId older, KeyframeId newer) const;

  const Map& map_;
  const std::vector<KeyframeId>& keyframes_;
  std::vector<double> variances_;  // of the way from the first keyframe to each, over s^2
};

}  // namespace hullslam
