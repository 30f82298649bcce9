// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace hullslam::synthetic {

// The content that an output folder may already have.
struct FormerOutput {
  std::string what;  // "a sequence", for messages
  // Whether the folder contains such an output of make_synthetic and nothing else.
  std::function<bool(const std::filesystem::path&)> is_former;
  bool force = false;  // whether it may be replaced
};

// Writes a folder as a whole. `write` gets a new, empty folder beside `folder`; if it returns true,
// this folder is moved to `folder`, else it is removed. So a failed or interrupted call leaves
// nothing, and an earlier output stays as it was. What killed processes have left is removed.
// Returns what `write` returned. Throws InputError if `folder` exists and may not be replaced, or
// if it cannot be written.
bool WriteStaged(const std::filesystem::path& folder, const FormerOutput& former,
                 const std::function<bool(const std::filesystem::path&)>& write);

}  // namespace hullslam::synthetic
