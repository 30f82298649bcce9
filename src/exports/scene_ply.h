// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "exports/export_input.h"

namespace hullslam {

// PLY files of PlyWriter (results/ply_file.h).

// Only the points.
std::string FormatPointsPly(std::span<const ColouredPoint> points);

// The points, each keyframe as an orange pyramid that opens in the direction in which it looks, and
// the objects as shapes in the colours of their classes. Faces are `uchar 3, int a b c`.
std::string FormatScenePly(const ExportModel& model, ObjectShape shape);

}  // namespace hullslam
