// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"

namespace hullslam {

struct BundleResult {
  std::vector<std::pair<KeyframeId, Rigid3>> poses;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> positions;
  std::vector<std::pair<LandmarkId, KeyframeId>> outliers;  // observations to be removed
  std::vector<std::pair<ObjectId, Ellipsoid>> ellipsoids;
  // Objects whose result is not finite, is not in front of all cameras that see it, or has a half
  // axis that changed by more than a factor of three. They keep the shape that they had and should
  // be checked.
  std::vector<ObjectId> failed_objects;
  bool is_usable = false;  // false if the solver failed; then there is no result to apply
  int residuals = 0;       // number of inlier observations of landmarks and of costs on objects
  int iterations = 0;
};

// Writes the result into the map that it was computed from. The map may have changed since then;
// entities that no longer exist are skipped.
void ApplyBundle(Map& map, const BundleResult& result, const ScaleLevels& levels);

// A monocular bundle adjustment with a single fixed keyframe does not determine the scale: the
// whole result may shrink towards the centre of that camera without a change of the residuals.
// KeepScale scales the result about this centre, so that the sum of the distances of the moving
// cameras from the fixed one is the same as before the adjustment.
void KeepScale(const Map& map, KeyframeId fixed, BundleResult& result);

}  // namespace hullslam
