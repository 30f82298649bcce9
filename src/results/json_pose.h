// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "files/json_file.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Reads a pose from an array [tx, ty, tz, qx, qy, qz, qw], in metres, and normalises the rotation.
// Throws InputError that names the file and the value if the node is no such array.
Rigid3 PoseOf(const JsonNode& node);

}  // namespace hullslam
