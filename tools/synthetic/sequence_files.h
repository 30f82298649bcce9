// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "synthetic/sequence_plan.h"

namespace hullslam::synthetic {

// Writes the files of a sequence that are not images or masks: lists, ground truth, settings and
// true objects (docs/synthetic.md). Folders must exist. Throws InputError if a file cannot be
// written.
void WriteSequenceFiles(const std::filesystem::path& folder, const SequencePlan& plan);

// Writes a file. Throws InputError if that fails.
void WriteNewFile(const std::filesystem::path& path, const std::string& content);

}  // namespace hullslam::synthetic
