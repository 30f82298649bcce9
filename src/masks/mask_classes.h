// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hullslam {

// The 80 classes of COCO, numbered from 0 as in detectors: 0 is person, 79 is toothbrush.
const std::vector<std::string>& CocoClasses();

// The class with the number `id` in the annotations of COCO. These numbers run from 1 to 90, but
// ten of them have no class; the result is then absent.
std::optional<std::string> CocoCategory(int64_t id);

// The names in `folder`/classes.txt, one per line; the first line is class 0. Without this file,
// the names of COCO. Throws InputError for a file without names or larger than 1 MB.
std::vector<std::string> ReadClasses(const std::filesystem::path& folder);

}  // namespace hullslam
