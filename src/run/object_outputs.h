// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/system/system.h"
#include "report/object_report.h"
#include "results/output_folder.h"
#include "results/summary.h"
#include "scene/scene.h"

namespace hullslam {

// The objects of a map, and how well each fits its observations.
ObjectReport CollectObjects(const Map& map, const PinholeCamera& camera,
                            const std::filesystem::path& sequence);

// The text "objects of the map: 12 seen again, ...", and one line for each object that was moved,
// is gone or is new.
std::string DescribeChanges(const std::vector<ChangedObject>& changes);

ObjectsSummary SummarizeObjects(const ObjectReport& report, const ObjectCounts& counts);

// The scene of the map that `report` is about. `groundtruth` is that of the sequence, if it has
// one: it tells which direction is upwards. Without it the horizontal planes of the landmarks tell
// this.
Scene CollectScene(const Map& map, const ObjectReport& report,
                   const std::optional<Trajectory>& groundtruth);

// The contents of objects.json, objects_observations.json, objects.csv, objects.ply and scene.json,
// so that they can be written together with the other files of a run.
std::vector<FileContent> ObjectFiles(const ObjectReport& report, const Scene& scene);

// The number with this many decimals; "-" if it is absent.
std::string FormatFigure(const std::optional<double>& figure, int decimals);

// "7 objects, 3 not mapped; means: SIoU 0.810 with hulls, ..." `unit` is the unit of length of the
// map: "m", or "u" if it is unknown.
std::string DescribeObjects(const ObjectsSummary& summary, const char* unit);

}  // namespace hullslam
