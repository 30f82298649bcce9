// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/object_results.h"
#include "results/summary.h"
#include "run/run_arguments.h"

namespace hullslam {

// Prints the results of a SLAM run.
void PrintResults(const RunArguments& arguments, const RunSummary& summary,
                  const ObjectResults& objects);

// The text "objects of the map: 12 seen again, ...", and one line for each object that was moved,
// is gone or is new.
std::string DescribeChanges(const std::vector<ChangedObject>& changes);

// The number with this many decimals; "-" if it is absent.
std::string FormatFigure(const std::optional<double>& figure, int decimals);

// "7 objects, 3 not mapped; means: SIoU 0.810 with hulls, ..." `unit` is the unit of length of the
// map: "m", or "u" if it is unknown.
std::string DescribeObjects(const ObjectsSummary& summary, const char* unit);

}  // namespace hullslam
