// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "eval/object_groundtruth.h"

namespace hullslam {

// Reads `groundtruth_objects.json` (docs/synthetic.md) of a scene as it was built or of a
// rearranged one. Throws InputError with the name of the file and the path of the key for missing
// keys, for values of another type, and if two objects have the same id.
TrueScene ReadTrueScene(const std::filesystem::path& path);

}  // namespace hullslam
