// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "files/json_node.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The pose in an array [tx, ty, tz, qx, qy, qz, qw], in metres; the rotation is normalised. Throws
// InputError that names the file and the value if it is none.
Rigid3 PoseOf(const JsonNode& node);

}  // namespace hullslam
