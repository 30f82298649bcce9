// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "report/object_results.h"
#include "scene/scene.h"
#include "scene/up_direction.h"

namespace hullslam {

// The scene of a map. `report` has the objects of the same map with their fits; only mapped objects
// take part. If the upward direction is not known, there are no boxes, no surfaces, and only the
// relations that follow from the observations.
Scene MakeScene(const Map& map, const ObjectResults& report, const UpDirection& up);

// The same with the upward direction that FindUp() finds: from the ground truth of the sequence if
// it has one, else from the horizontal planes of the landmarks.
Scene MakeScene(const Map& map, const ObjectResults& report,
                const std::optional<Trajectory>& groundtruth);

}  // namespace hullslam
