// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/atomic_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "hullslam/util/error.h"
#include "io/synced_file.h"
#include "util/staging_folder.h"

namespace hullslam {
namespace {

void CheckTarget(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    // Renaming would replace a device or a pipe by a file.
    throw InputError(path.string() + ": cannot be written: it is not a regular file");
  }
}

}  // namespace

void WriteFileAtomically(const std::filesystem::path& path, std::string_view content) {
  CheckTarget(path);
  try {
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
    const std::string prefix = fmt::format(".{}.", path.filename().string());
    StagingFolder::Abandoned(parent, prefix);  // removes what killed processes have left
    const StagingFolder staging(parent, prefix);
    const std::filesystem::path temporary = staging.content() / "file";
    WriteSyncedFile(temporary, content, path);
    if (std::rename(temporary.c_str(), path.c_str()) != 0) {
      FailWriting(path, errno);
    }
  } catch (const std::filesystem::filesystem_error& error) {
    FailWriting(path, error.code().value());
  }
}

}  // namespace hullslam
