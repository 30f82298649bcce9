// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "support/paths.h"

namespace hullslam {

// Finds a file or folder of the real sequences and golden trajectories. They are in $HULLSLAM_DATA
// or, if this is not set, in a folder `shared/data` next to the source tree or one of its parent
// folders. Returns nothing if it does not exist on this machine.
inline std::optional<std::filesystem::path> FindTestData(const std::string& relative) {
  namespace fs = std::filesystem;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): no other thread sets the environment
  if (const char* const folder = std::getenv("HULLSLAM_DATA")) {
    const fs::path path = fs::path(folder) / relative;
    return fs::exists(path) ? std::optional(path) : std::nullopt;
  }
  const fs::path source = SourceFolder();
  for (fs::path parent = source; parent != parent.root_path(); parent = parent.parent_path()) {
    const fs::path path = parent.parent_path() / "shared" / "data" / relative;
    if (fs::exists(path)) {
      return path;
    }
  }
  return std::nullopt;
}

}  // namespace hullslam
