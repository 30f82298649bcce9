// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "hullslam/eval/true_object.h"

namespace hullslam {

// Reads `groundtruth_objects.json` (docs/synthetic.md). Throws InputError with the name of the file
// and the path of the key for missing keys and for values of another type.
std::vector<TrueObject> ReadTrueObjects(const std::filesystem::path& path);

}  // namespace hullslam
