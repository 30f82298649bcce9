// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace hullslam {

// The folder of real sequences and golden trajectories: $HULLSLAM_DATA, else `shared/data` beside
// one of the parents of the source tree; nothing where this machine has neither.
inline std::optional<std::filesystem::path> FindTestData(const std::string& relative) {
  namespace fs = std::filesystem;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody sets the environment meanwhile
  if (const char* const folder = std::getenv("HULLSLAM_DATA")) {
    const fs::path path = fs::path(folder) / relative;
    return fs::exists(path) ? std::optional(path) : std::nullopt;
  }
  const fs::path source = fs::path(HULLSLAM_SOURCE_DIR);
  for (fs::path parent = source; parent != parent.root_path(); parent = parent.parent_path()) {
    const fs::path path = parent.parent_path() / "shared" / "data" / relative;
    if (fs::exists(path)) {
      return path;
    }
  }
  return std::nullopt;
}

}  // namespace hullslam
