// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

enum class AlignmentKind {
  kNone,  // no alignment: the points stay where they are
  kSe3,   // rotation and translation
  kSim3,  // rotation, translation and scale
};

// x_target = scale * rotation * x_source + translation.
struct PointAlignment {
  double scale = 1.0;
  Rigid3 target_from_source;
  std::string failure;  // empty if the alignment succeeded, else the reason

  bool ok() const { return failure.empty(); }
  Eigen::Vector3d operator*(const Eigen::Vector3d& source) const {
    return target_from_source * (scale * source);
  }
};

// Returns the alignment of `kind` with the least sum of squared distances between target and
// aligned source points (Umeyama 1991). Both lists have the same length. The result is a failure
// with the identity if there are fewer than three points, or if the points do not determine the
// scale. For points on one line the rotation about this line is arbitrary; the distances are still
// the least.
PointAlignment AlignPoints(std::span<const Eigen::Vector3d> source,
                           std::span<const Eigen::Vector3d> target, AlignmentKind kind);

// Returns the rigid motion that best maps the source poses to the target poses (of cameras, world
// from camera), both positions and orientations. It has the least sum of squared distances between
// target and aligned source points, where each pose counts by six points: those at the distance
// `lever` (m, > 0) from its position on both sides of each of its axes. So an error of the
// orientation counts as the shift that it causes at this distance. One pose is enough. Both lists
// have the same length, which is not 0.
Rigid3 AlignPoses(std::span<const Rigid3> source, std::span<const Rigid3> target, double lever);

}  // namespace hullslam
