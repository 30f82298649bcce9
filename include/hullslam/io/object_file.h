// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "hullslam/report/object_report.h"

namespace hullslam {

// The text of `objects.json` (docs/outputs.md): everything that the shapes were judged by, so that
// they can be judged again from this file alone. Pixels are rounded to 0.01, metres to 1e-9. The
// same report gives the same bytes. CheckError for values that are not finite.
std::string FormatObjects(const ObjectReport& report);

// Reads what FormatObjects() wrote. Throws InputError with the file's name and the key's place for
// anything else.
ObjectReport ReadObjects(const std::filesystem::path& path);

}  // namespace hullslam
