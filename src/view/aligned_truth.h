// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/geometry/alignment.h"
#include "hullslam/geometry/trajectory.h"
#include "view/view_model.h"

namespace hullslam {

// Adds the ground truth, moved into the world of the map, and the error of each pose of
// `model.trajectory`. Poses are paired by TUM's rule and aligned as for the ATE (eval/ate.h). If
// they cannot be aligned, nothing is added, and the reason is returned; else the text is empty.
std::string AddGroundtruth(const Trajectory& groundtruth, AlignmentKind alignment,
                           ViewModel& model);

// The direction that the tops of the images point to on average, in the world of the map. If the
// ground truth was aligned, the nearest of its axes takes its place, unless they are more than 40
// degrees apart. Absent if the camera was held in too many ways. `truth_from_map` may be null.
std::optional<Eigen::Vector3d> FindUp(const Trajectory& poses,
                                      const Eigen::Matrix3d* truth_from_map);

}  // namespace hullslam
