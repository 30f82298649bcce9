// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "scene/joint_observations.h"
#include "scene/object_body.h"
#include "scene/scene.h"

namespace hullslam {

struct SceneRelations {
  std::vector<Relation> relations;  // by subject, kind and object
  std::vector<Surface> surfaces;    // by increasing height
};

// The relations that need the upward direction: on, supports, in, part of and beside. docs/scene.md
// defines them; the bounds are the constants of the source.
SceneRelations FindStandingRelations(std::span<const ObjectBody> measured,
                                     const ObservationStatistics& observations);

// The relations that follow from the observations alone: in front of and hidden by.
std::vector<Relation> FindObservedRelations(const ObservationStatistics& observations);

}  // namespace hullslam
