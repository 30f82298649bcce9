// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "hullslam/eval/true_object.h"

namespace hullslam {

// Reads `groundtruth_objects.json` (docs/synthetic.md). Throws InputError with the file's name and
// the key's place for missing keys and values of another kind.
std::vector<TrueObject> ReadTrueObjects(const std::filesystem::path& path);

}  // namespace hullslam
