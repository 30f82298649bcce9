// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

enum class AlignmentKind {
  kNone,  // the points are compared as they are
  kSe3,   // rotation and translation
  kSim3,  // rotation, translation and scale
};

// x_target = scale * rotation * x_source + translation.
struct PointAlignment {
  double scale = 1.0;
  Rigid3 target_from_source;
  std::string failure;  // empty where the alignment is good, else the reason

  bool ok() const { return failure.empty(); }
  Eigen::Vector3d operator*(const Eigen::Vector3d& source) const {
    return target_from_source * (scale * source);
  }
};

// The alignment with the least sum of squared distances between target and aligned source points
// (Umeyama 1991), of `kind`. Both lists have the same length. Fails, with the identity, for fewer
// than three points and for a scale that no spread of the points fixes. For points on one line the
// rotation about it is arbitrary, while the distances are still the least.
PointAlignment AlignPoints(std::span<const Eigen::Vector3d> source,
                           std::span<const Eigen::Vector3d> target, AlignmentKind kind);

}  // namespace hullslam
