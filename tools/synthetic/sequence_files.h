// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "synthetic/sequence_plan.h"

namespace hullslam::synthetic {

// Writes the files of a sequence that are not images or masks: lists, ground truth, settings and
// true objects (docs/synthetic.md). `masks` counts the masks of each object of the scene; empty if
// they are not known. Folders must exist. Throws InputError if a file cannot be written.
void WriteSequenceFiles(const std::filesystem::path& folder, const SequencePlan& plan,
                        const std::vector<uint32_t>& masks = {});

// Writes a file. Throws InputError if that fails.
void WriteNewFile(const std::filesystem::path& path, const std::string& content);

}  // namespace hullslam::synthetic
