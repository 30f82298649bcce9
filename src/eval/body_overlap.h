// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

enum class BodyKind { kBox, kCylinder, kEllipsoid };

const char* ToString(BodyKind kind);

// A solid in the world. Its centre is the origin of its frame, and its half axes lie along the axes
// of this frame. A cylinder stands along z and may have an elliptic section.
struct Body {
  BodyKind kind = BodyKind::kEllipsoid;
  Rigid3 world_from_body;
  Eigen::Vector3d half_axes = Eigen::Vector3d::Ones();  // m, each > 0

  double Volume() const;  // m^3
  // Mean of the three full extents, m.
  double Size() const { return 2.0 * half_axes.mean(); }
};

// Volume of the intersection over the one of the union, 0 to 1, of the tight boxes of two bodies,
// each along the axes of its own body. The intersection is exact: one box is clipped by the six
// sides of the other.
double BoxOverlap(const Body& a, const Body& b);

// The same for the solids themselves. For two boxes the result is exact. Otherwise the volume of
// the intersection is a sum over 128 x 128 parallel lines through the smaller body, each of which
// meets both bodies in an interval; the error of the result is below 0.01.
double SolidOverlap(const Body& a, const Body& b);

}  // namespace hullslam
