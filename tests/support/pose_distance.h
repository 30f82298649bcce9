// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The Frobenius norm of the difference of the matrices of two poses; 0 if they are equal.
inline double Distance(const Rigid3& a, const Rigid3& b) {
  return (a.ToMatrix() - b.ToMatrix()).norm();
}

}  // namespace hullslam
