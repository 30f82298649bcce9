// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "exports/mcap_recording.h"
#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "run/run_arguments.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// Adds --report.
void AddReportFlag(CLI::App& app, bool& report);

// Writes report.html into the folder of a run whose results were written there. The map and the
// sequence add what the files do not have. Prints where the report is and what was left out,
// without the former if `is_quiet`. Returns why the report could not be written; empty if there was
// no error. The results stay as they are in any case.
std::string WriteReport(const std::filesystem::path& folder, const Map& map,
                        const SystemOptions& options, const ImageSequence& sequence, bool is_quiet);

// The report of a finished run or of a file of --save-map as the text of a page. Throws InputError
// if `source` is neither. Prints what was left out.
std::string ReportOf(const std::filesystem::path& source);

// Adds --mcap.
void AddMcapOption(CLI::App& app, std::filesystem::path& file);

// Writes the run into the file of --mcap if it is given. Returns why it could not be written, for
// example because the disk is full; empty if there was no error.
std::string WriteMcap(const RunArguments& arguments, const RecordedRun& run);

}  // namespace hullslam
