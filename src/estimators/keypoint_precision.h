// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace hullslam::internal {

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
