// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace hullslam {

// Writes `content` to `path` so that the file is either complete or not there at all: it is written
// and synced in a temporary folder beside it, and then renamed. Throws InputError with `path` and
// the reason of the system if this fails (disk full, folder missing or not writable). Then an
// earlier file at `path` is unchanged. A link is followed. The files of a run are written together:
// see OutputFolder.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

// Throws InputError if WriteFileAtomically() could not write a small file at `path` now. Changes
// nothing there.
void ProbeFile(const std::filesystem::path& path);

}  // namespace hullslam
