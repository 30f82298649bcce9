// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"

namespace hullslam {

// The report of a run or a map: a page that shows everything without a server.
struct Report {
  std::string page;
  std::vector<std::string> notes;  // what was left out, and why
};

// The report of a run whose results are in the folder. The map and the sequence add what the files
// do not have; a mark at the end of the page says so. Throws InputError if the files are not
// from a run.
Report MakeReport(const std::filesystem::path& folder, const Map& map, const SystemOptions& options,
                  const ImageSequence& sequence);
// Whether report.html in the folder has the mark of the run whose results are there, and shows the
// surface of mesh.ply if there is one. Then it shows more than the files tell.
bool HasOwnReport(const std::filesystem::path& folder);
// The report of a finished run, of which only the files are left: the one that the run has written,
// with the surface that was made since; else what the other files tell.
Report MakeReport(const std::filesystem::path& folder);
// The report of a finished run or of a file of --save-map, whichever `source` is. `version` is that
// of the program.
Report MakeReportOf(const std::filesystem::path& source, const std::string& version);
// Where it is written by default: report.html in the folder of a run. A map is no part of a folder
// of results, so its report has the name of the map.
std::filesystem::path DefaultReportPath(const std::filesystem::path& source);

}  // namespace hullslam
