// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
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

// Sets the upward direction, from the trajectory and landmarks of the model (scene/up_direction.h).
// If neither the ground truth nor planes tell it, it is guessed from the images.
void AddUp(const std::optional<Trajectory>& groundtruth, ViewModel& model);

}  // namespace hullslam
