// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/staged_output.h"

#include <fmt/format.h>

#include <system_error>

#include "files/paths.h"
#include "files/staged_file.h"
#include "hullslam/util/error.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

void CheckReplaceable(const fs::path& folder, const FormerOutput& former) {
  const fs::file_status status = fs::status(folder);
  if (!fs::exists(status)) {
    return;
  }
  if (!fs::is_directory(status)) {
    throw InputError(folder.string() + ": exists and is not a folder");
  }
  if (fs::is_empty(folder)) {
    return;
  }
  if (!former.is_former(folder)) {
    throw InputError(
        fmt::format("{}: is not empty and is not (only) {} of make_synthetic; choose another "
                    "folder",
                    folder.string(), former.what));
  }
  if (!former.force) {
    throw InputError(
        fmt::format("{}: already contains {}; --force replaces it", folder.string(), former.what));
  }
}

// Makes the folder beside `folder` in which the output is written. Folders that killed processes
// have left are removed.
StagingFolder Stage(const fs::path& folder) {
  const std::string prefix = fmt::format(".{}.partial-", folder.filename().string());
  fs::create_directories(folder.parent_path());
  StagingFolder::Abandoned(folder.parent_path(), prefix);  // their destructors remove them
  return {folder.parent_path(), prefix};
}

// Moves a complete output to its final path. An earlier one moves to the staging folder, whose
// destructor removes it.
void MoveToFolder(const StagingFolder& staging, const fs::path& folder) {
  const fs::path former = staging.path() / "former";
  const bool replaces = fs::exists(folder);
  if (replaces) {
    fs::rename(folder, former);
  }
  std::error_code error;
  fs::rename(staging.content(), folder, error);
  if (error) {
    if (replaces) {
      fs::rename(former, folder);
    }
    throw fs::filesystem_error("rename", folder, error);
  }
}

}  // namespace

bool WriteStaged(const fs::path& folder, const FormerOutput& former,
                 const std::function<bool(const fs::path&)>& write) {
  try {
    const fs::path target = CanonicalPath(folder);
    CheckReplaceable(target, former);
    const StagingFolder staging = Stage(target);
    if (!write(staging.content())) {
      return false;
    }
    MoveToFolder(staging, target);
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be written: " + error.code().message());
  }
  return true;
}

}  // namespace hullslam::synthetic
