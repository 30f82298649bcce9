// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace hullslam {

// Puts `content` at `path` so that the file is there whole or not at all: written and synced under
// a temporary name in the same folder, then renamed. Throws InputError that names `path` and the
// system's reason where that fails (disk full, folder missing or not writable); the temporary file
// is removed and a former file at `path` stays as it was.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

}  // namespace hullslam
