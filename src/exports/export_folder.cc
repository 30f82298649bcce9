// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_folder.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "files/staging_folder.h"
#include "files/synced_file.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStagingPrefix = ".hullslam-";

bool HasFiles(const fs::path& folder) {
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  if (error) {
    throw InputError(folder.string() + ": cannot be read: " + error.message());
  }
  return std::any_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return !entry.path().filename().string().starts_with(kStagingPrefix);
  });
}

[[noreturn]] void FailOn(const fs::path& path, const fs::filesystem_error& error) {
  throw InputError(path.string() + ": cannot be written: " + error.code().message());
}

}  // namespace

void CheckExportPath(const fs::path& path, std::span<const fs::path> inputs, bool force) {
  CheckApartFromInputs(path, inputs);
  std::error_code error;
  if (force || !fs::exists(path, error)) {
    return;
  }
  if (!fs::is_directory(path, error)) {
    throw InputError(path.string() + ": exists already; choose another name, or give --force");
  }
  if (HasFiles(path)) {
    throw InputError(path.string() +
                     ": has files already; choose an empty or a new folder, or give --force");
  }
}

ExportFolder::ExportFolder(fs::path path) : path_(std::move(path)) {
  try {
    is_new_ = fs::create_directories(path_);
    StagingFolder::Abandoned(path_, kStagingPrefix);  // removes what killed processes have left
    staging_ = std::make_unique<StagingFolder>(path_, kStagingPrefix);
  } catch (const fs::filesystem_error& error) {
    FailOn(path_, error);
  }
}

ExportFolder::~ExportFolder() {
  staging_.reset();
  if (is_new_) {
    std::error_code ignored;
    fs::remove(path_, ignored);  // only removes an empty folder
  }
}

void ExportFolder::Write(const FileContent& file) {
  const fs::path staged = staging_->content() / file.name;
  try {
    fs::create_directories(staged.parent_path());
  } catch (const fs::filesystem_error& error) {
    FailOn(path_ / file.name, error);
  }
  WriteSyncedFile(staged, file.content, path_ / file.name);
}

void ExportFolder::Commit() {
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(staging_->content())) {
      const fs::path target = path_ / entry.path().filename();
      fs::remove_all(target);
      fs::rename(entry.path(), target);
    }
  } catch (const fs::filesystem_error& error) {
    FailOn(path_, error);
  }
}

}  // namespace hullslam
