// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hullslam/system/system.h"
#include "report/object_report.h"
#include "results/summary.h"

namespace hullslam {

// The text "objects of the map: 12 seen again, ...", and one line for each object that was moved,
// is gone or is new.
std::string DescribeChanges(const std::vector<ChangedObject>& changes);

ObjectsSummary SummarizeObjects(const ObjectReport& report, const ObjectCounts& counts);

// The number with this many decimals; "-" if it is absent.
std::string FormatFigure(const std::optional<double>& figure, int decimals);

// "7 objects, 3 not mapped; means: SIoU 0.810 with hulls, ..." `unit` is the unit of length of the
// map: "m", or "u" if it is unknown.
std::string DescribeObjects(const ObjectsSummary& summary, const char* unit);

}  // namespace hullslam
