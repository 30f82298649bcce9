// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "exports/mcap_recording.h"
#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "hullslam/system/system.h"
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

// Throws InputError unless the files of --save-map and --mcap, if they are given, can be written
// and are neither in the output folder, where the next run would remove them, nor one of the inputs
// or inside of one. The file of --load-map may be replaced.
void CheckSavedFiles(const RunArguments& arguments);

// The start of the run: the map of --load-map if it is given. Throws InputError for a map that
// cannot be read or that was made with another camera or image pyramid, and ReadingCancelled after
// a signal.
SystemStart LoadStart(const RunArguments& arguments, const SystemOptions& options);

// Writes the map to the file of --save-map if it is given. A map without keyframes is not written;
// a warning says so. Returns why the map could not be written, for example because the disk is
// full; empty if there was no error.
std::string SaveMap(const RunArguments& arguments, const SystemOptions& options, const Map& map);

// Writes the maps of these islands beside the file of --save-map if it is given: desk_island2.map
// beside desk.map. They replace earlier ones. Returns the first error as SaveMap does.
std::string SaveIslands(const RunArguments& arguments, const SystemOptions& options,
                        std::span<const LeftIsland> islands);

// The title of the session of the run in its trajectory: the map had `earlier_sessions` sessions
// before. Without --load-map there is none.
std::optional<std::string> SessionTitle(const RunArguments& arguments, size_t earlier_sessions);

}  // namespace hullslam
