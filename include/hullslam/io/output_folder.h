// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace hullslam {

// Makes the folder, with its parents, where it is missing, and proves that files can be written
// there; the folder's files are left alone. Throws InputError with the folder and the system's
// reason. To be called before the first frame, so that no run is lost for want of a place.
void PrepareOutputFolder(const std::filesystem::path& folder);

}  // namespace hullslam
