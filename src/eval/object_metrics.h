// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "report/object_results.h"

namespace hullslam {

// The solid angle of a polygon of undistorted pixels, steradians; negative if the polygon has a
// negative area. The part of a pixel in it falls with the third power of the cosine of the angle
// from the axis, so areas in the undistorted image of a fisheye lens weigh its rim too much.
double SolidAngle(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon);

// Solid angle of the intersection over the one of the union, 0 to 1, of a polygon and a convex one,
// both of positive area; 0 for two empty sets.
double OverlapOnSphere(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon,
                       std::span<const Eigen::Vector2d> convex);

// Measures the agreement of the projected ellipses of an ellipsoid with its observations:
//   siou        intersection over union with the hull, both clipped to the undistorted image. If
//               the observation has only a box, the bounding box of the ellipse is compared with
//               it. With a fisheye lens, solid angles are used instead of areas.
//   siou_mask   the same with the contour; absent for a box
//   mtd_m2      mean of |pi^T Q* pi| over the planes of the two-sided lines, with unit normals
//               (Yu et al. 2025, Eq. 8); absent without such lines
//   tangent_px  mean distance of these lines from the parallel tangents of the ellipse; absent
//               without such lines
//
// An ellipsoid that is not wholly in front of the camera has no projected ellipse. In such an
// observation the overlaps are 0 and the distances are absent. Returns the means over the
// observations; all values are absent if there are no observations.
ObjectFit MeasureObject(const Ellipsoid& ellipsoid, std::span<const ObservationResult> observations,
                        const PinholeCamera& camera);

// Fills in the fit of every object.
void MeasureObjects(ObjectResults& report);
// The objects of a map with their fits. `sequence` is ObjectResults::sequence.
ObjectResults MeasuredObjects(const Map& map, const PinholeCamera& camera,
                              const std::string& sequence = {});

// Summary of all mapped objects: means of their fits and sums of their counts.
struct MapFit {
  size_t objects = 0;
  ObjectFit mean;
};

MapFit SummarizeFits(const ObjectResults& report);

}  // namespace hullslam
