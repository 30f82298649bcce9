// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "report/object_results.h"
#include "results/summary.h"

namespace hullslam {

// The results of a SLAM run as lines of text for people. `keeps_islands` says that parts of the map
// that were not joined have been written too.
std::string DescribeRun(const RunSummary& summary, const ObjectResults& objects, SensorKind sensor,
                        bool keeps_islands);

// The state of tracking and the size of the map (null: none yet) as text for the progress of a run.
// `failure`: why there is no map yet.
std::string DescribeState(TrackingState state, std::optional<InitialisationFailure> failure,
                          const Map* map);

// The text "objects of the map: 12 seen again, ...", and one line for each object that was moved,
// is gone or is new.
std::string DescribeChanges(const std::vector<ChangedObject>& changes);

// The number with this many decimals; "-" if it is absent.
std::string FormatFigure(const std::optional<double>& figure, int decimals);

// "7 objects, 3 not mapped; means: SIoU 0.810 with hulls, ..." `unit` is the unit of length of the
// map: "m", or "u" if it is unknown.
std::string DescribeObjects(const ObjectsSummary& summary, const char* unit);

// A table of the mapped objects, in metres.
std::string DescribeMapped(const Map& map, const ObjectResults& report);

}  // namespace hullslam
