// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "hullslam/report/object_report.h"

namespace hullslam {

// The text of `objects.json` (docs/outputs.md). It has everything that is needed to judge the
// shapes of the objects, so that they can be judged again from this file alone. Pixels are rounded
// to 0.01, metres to 1e-9. The same report gives the same bytes. Throws CheckError for values that
// are not finite.
std::string FormatObjects(const ObjectReport& report);

// Reads a file that FormatObjects() wrote. For anything else it throws InputError with the name of
// the file and the path of the key.
ObjectReport ReadObjects(const std::filesystem::path& path);

}  // namespace hullslam
