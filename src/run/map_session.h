// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hullslam/results/trajectory_file.h"
#include "hullslam/system/options.h"
#include "hullslam/system/system.h"
#include "hullslam/system/system_start.h"
#include "run/run_arguments.h"

namespace hullslam {

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

// "_island2" for the second island that was begun: part of the names of its files.
std::string IslandSuffix(IslandId island);

// Writes the maps of these islands beside the file of --save-map if it is given: desk_island2.map
// beside desk.map. They replace earlier ones. Returns the first error as SaveMap does.
std::string SaveIslands(const RunArguments& arguments, const SystemOptions& options,
                        std::span<const LeftIsland> islands);

// RunParts() gives the trajectory of the run, with the title of its session: the map had
// `earlier_sessions` sessions before. KeyframeParts() gives the poses of the keyframes, with one
// part per session. Without --load-map there are no titles.
std::vector<TrajectoryPart> RunParts(const RunArguments& arguments, size_t earlier_sessions,
                                     const Trajectory& trajectory);
std::vector<TrajectoryPart> KeyframeParts(const RunArguments& arguments, const Map& map);

}  // namespace hullslam
