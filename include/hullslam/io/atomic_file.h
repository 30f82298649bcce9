// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace hullslam {

// Puts `content` at `path` so that the file is there whole or not at all: written and synced under
// a temporary name in the same folder, then renamed. Throws InputError that names `path` and the
// system's reason where that fails (disk full, folder missing or not writable); the temporary file
// is removed and a former file at `path` stays as it was.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

struct FileContent {
  std::filesystem::path path;
  std::string content;
};

// The same for files that belong together: all are written and synced before the first one is
// renamed, so that a disk that fills up on the way leaves all former files as they were. (Only
// where a rename itself fails, as no full disk makes it, are the files before it new already.)
void WriteFilesAtomically(std::span<const FileContent> files);

}  // namespace hullslam
