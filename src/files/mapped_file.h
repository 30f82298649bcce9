// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace hullslam {

// The content of a file in memory, aligned to at least 16 bytes. Copies share it.
struct FileBytes {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;
};

// Maps a regular file into memory, without copying it. While it is mapped, the file may be replaced
// by another one, but it must not become shorter. A pipe is read instead. Throws InputError like
// ReadFile().
FileBytes MapFile(const std::filesystem::path& path, size_t most_bytes);

}  // namespace hullslam
