// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The residuals that can hold a quadric (docs/objects.md); each has its own file in costs/.
enum class ObjectResidual { kTangent, kAlgebraicPlane, kAlgebraicPoint, kDistribution, kOverlap };

// What of a detection they are computed from.
enum class ObjectPrimitive { kSupport, kHull, kContour, kBox, kConic };

}  // namespace hullslam
