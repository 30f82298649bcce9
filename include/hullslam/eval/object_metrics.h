// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "hullslam/report/object_report.h"

namespace hullslam {

// How well an ellipsoid's outline agrees with one view of it:
//   siou        intersection over union with the hull, both clipped to the (undistorted) image; of
//   a
//               view that knows a box alone, that of the outline's box with it
//   siou_mask   the same with the contour; absent for a box
//   mtd_m2      mean of |pi^T Q* pi| over the planes of the two-sided lines, with unit normals (Yu
//   et
//               al. 2025, Eq. 8); absent without such lines
//   tangent_px  mean distance of these lines from the outline's parallel tangents
// Where the ellipsoid is not wholly in front of the camera it has no outline: the overlaps are 0
// and the distances absent.
ObjectFit MeasureView(const Ellipsoid& ellipsoid, const ReportedView& view,
                      const PinholeCamera& camera);

// Means over the views; no value at all without views.
ObjectFit MeasureObject(const Ellipsoid& ellipsoid, std::span<const ReportedView> views,
                        const PinholeCamera& camera);

// Fills in the fit of every object.
void MeasureObjects(ObjectReport& report);

// Of all mapped objects: means of their fits, sums of their counts.
struct MapFit {
  size_t objects = 0;
  ObjectFit mean;
};

MapFit SummarizeFits(const ObjectReport& report);

}  // namespace hullslam
