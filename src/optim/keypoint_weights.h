// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/map/keyframe.h"

namespace hullslam::internal {

// The weights of the keypoints of a keyframe in bundle adjustment.
//
// A corner is often found at several levels of the pyramid, which makes several landmarks with the
// same error. Without weights its error would count several times. That does most harm where the
// corner is no point of the world: where one edge passes behind another, the corner slides along
// both.
//
// Let N_k be the keypoints that show a landmark and are less than 3 px away from keypoint k in x
// and in y, including k, and let i_j = 1 / sigma_j^2 be the information of keypoint j at its
// pyramid level. The weight of the squared error of k is
//   w_k = max over N_k of i_j / sum over N_k of i_j.
// So if all keypoints of a group are near each other, their total information, sum of w_k i_k, is
// that of the most precise keypoint. A keypoint without such neighbours has weight 1. Returns one
// weight per keypoint, in (0, 1], or 0 where the keypoint shows no landmark.
std::vector<double> KeypointWeights(const Keyframe& keyframe, const ScaleLevels& levels);

// Measures the precision of keypoints: the standard deviation that the sensor assumes over the one
// that the errors show.
//
// The standard deviations of the sensor are cautious. With them, an error of several true standard
// deviations would count as an inlier. Points that slide along the edge of a door or along an
// occluding contour have such errors. If the camera hardly moves, a few such points are enough to
// change the scale.
//
// `chi2`: the squared reprojection errors of the inliers, in units of the standard deviations of
// the sensor divided by `precision`. `points`: the number of points that were fitted to them. With
// n errors of two equations each and three unknowns per point, the share
//   f = max(0.3, 1 - 3 points / (2 n))
// of the equations is free. The median of chi-square with two degrees of freedom is 2 ln 2, so
//   sigma = sqrt(median(chi2) / (2 ln 2 f)) / precision
// is the true standard deviation in units of that of the sensor. Returns 1 / sigma, at least 1 and
// at most 5, because even exact keypoints are rounded. Returns `precision` if there are fewer than
// 100 errors, too few for a median.
double MeasureKeypointPrecision(std::vector<double> chi2, size_t points, double precision);

// The factor of OutlierBound where the standard deviations are those of the sensor divided by
// `precision`: 2, because errors of keypoints have longer tails than a normal distribution with the
// same median, but never more than the bound of the sensor itself, which is `precision` squared.
double OutlierBoundFactor(double precision);

}  // namespace hullslam::internal
