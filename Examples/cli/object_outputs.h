// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/io/atomic_file.h"
#include "hullslam/io/summary.h"
#include "hullslam/report/object_report.h"
#include "hullslam/system/system.h"

namespace hullslam {

// The objects of a map with their fits.
ObjectReport CollectObjects(const Map& map, const PinholeCamera& camera,
                            const std::filesystem::path& sequence);

ObjectsSummary SummarizeObjects(const ObjectReport& report, const ObjectCounts& counts);

// objects.json and objects.ply, to be written with the other files of a run.
std::vector<FileContent> ObjectFiles(const std::filesystem::path& folder,
                                     const ObjectReport& report);

// With so many decimals, "-" for none.
std::string FormatFigure(const std::optional<double>& figure, int decimals);

// "7 objects, 3 candidates; mean SIoU 0.81 ..."
std::string DescribeObjects(const ObjectsSummary& summary);

}  // namespace hullslam
