// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "report/object_report.h"
#include "run/run_arguments.h"

namespace hullslam {

// Adds --mcap.
void AddMcapOption(CLI::App& app, std::filesystem::path& file);

// The results of a run, which must outlive the call.
struct McapContent {
  const SystemOptions* options = nullptr;
  const Map* map = nullptr;
  const ImageSequence* sequence = nullptr;
  size_t frames = 0;  // the first frames of the sequence, which the run was given
  const Trajectory* trajectory = nullptr;
  const ObjectReport* objects = nullptr;
};

// Writes the run into the file of --mcap if it is given (docs/datasets.md). The same results give
// the same bytes. Returns why it could not be written, for example because the disk is full; empty
// if there was no error.
std::string WriteMcap(const RunArguments& arguments, const McapContent& content);

}  // namespace hullslam
