// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace hullslam {

// Creates the folder and its parents if they are missing, and checks that files can be written
// there. Existing files are left alone. Throws InputError with the folder and the reason of the
// system. Call this before the first frame, so that no run is lost because its results cannot be
// written.
void PrepareOutputFolder(const std::filesystem::path& folder);

}  // namespace hullslam
