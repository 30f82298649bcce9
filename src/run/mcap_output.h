// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "exports/mcap_recording.h"
#include "run/run_arguments.h"

namespace hullslam {

// Adds --mcap.
void AddMcapOption(CLI::App& app, std::filesystem::path& file);

// Writes the run into the file of --mcap if it is given. Returns why it could not be written, for
// example because the disk is full; empty if there was no error.
std::string WriteMcap(const RunArguments& arguments, const RecordedRun& run);

}  // namespace hullslam
