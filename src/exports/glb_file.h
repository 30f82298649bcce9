// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "exports/export_input.h"

namespace hullslam {

// A binary glTF 2.0 file (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html) with one
// scene: a node "map" that turns the world of the map so that y points up, and in it the points,
// the path of the camera as a line, a camera for each keyframe, and a node for each object, which
// has the name of the class and further values in `extras`. Lengths are in the unit of the map. If
// the scene does not know what is upwards, it is where the top of the first image points.
std::string FormatGlb(const ExportModel& model, ObjectShape shape);

}  // namespace hullslam
