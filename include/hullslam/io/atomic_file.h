// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace hullslam {

// Writes `content` to `path` so that the file is either complete or not there at all: it is written
// and synced under a temporary name in the same folder, and then renamed. Throws InputError with
// `path` and the reason of the system if this fails (disk full, folder missing or not writable).
// Then the temporary file is removed, and an earlier file at `path` is unchanged.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

struct FileContent {
  std::filesystem::path path;
  std::string content;
};

// The same for files that belong together. All are written and synced before the first one is
// renamed, so a disk that becomes full leaves all earlier files unchanged. (Only if a rename itself
// fails, which a full disk does not cause, are the files before it already replaced.)
void WriteFilesAtomically(std::span<const FileContent> files);

}  // namespace hullslam
