// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "camera/point_measurement.h"
#include "estimators/ransac.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

struct AbsolutePose {
  Rigid3 cam_from_world;
  std::vector<size_t> inliers;  // indices of matches, increasing
  double score = 0.0;           // sum over the inliers of 1 - chi2 / bound
  int iterations = 0;           // samples drawn
  std::string failure;          // empty if the pose was found, else the reason

  bool ok() const { return failure.empty(); }
};

// The pose of a camera from matches between landmarks and keypoints, without an initial pose; many
// matches may be wrong. The method is RANSAC with P3P. A match is an inlier if its error
// (PointChi2) in pixel and, where it is known, depth is below OutlierBound. The pose is fitted to
// all inliers, without a robust loss; OptimizePose can refine it. Matches whose numbers are not
// finite are never inliers.
//
// Possible failures: there are too few matches; no three of them span a triangle; too few agree; or
// the inliers do not determine the rotation because all but one of them are nearly on one line.
AbsolutePose EstimateAbsolutePose(const PinholeCamera& camera,
                                  std::span<const PoseObservation> matches,
                                  const RansacOptions& options);

}  // namespace hullslam
