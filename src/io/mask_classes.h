// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hullslam {

// The 80 classes of COCO that detectors number from 0 on: 0 is person, 79 is toothbrush.
const std::vector<std::string>& CocoClasses();

// The class that COCO's own annotations number `id`, 1 to 90 with ten gaps; nothing in a gap.
std::optional<std::string> CocoCategory(int64_t id);

// The names in `folder`/classes.txt, one a line, by the number of the line from 0 on; COCO's where
// there is no such file. Throws InputError for a file without names or beyond 1 MB.
std::vector<std::string> ReadClasses(const std::filesystem::path& folder);

}  // namespace hullslam
