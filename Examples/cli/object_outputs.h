// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/io/summary.h"
#include "hullslam/map/object_report.h"

namespace hullslam {

// The map's objects and how well they fit, for objects.json and objects.ply.
ObjectReport MeasuredReport(const Map& map, const PinholeCamera& camera,
                            const std::string& sequence);

// What summary.json says of them. The counts of detections, frames and rejections, which the map
// does not know, are left at 0.
ObjectsSummary SummarizeObjects(const ObjectReport& report);

}  // namespace hullslam
