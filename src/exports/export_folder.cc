// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_folder.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/staged_file.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStagingPrefix = ".hullslam-";
constexpr const char* kReady = "ready";  // folder of a complete export inside a staging folder

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

// Moves the entries of a complete export to its folder. A file replaces the former one at once; a
// former folder is first moved beside `ready`, so nothing is lost if the process is killed. It can
// be called again after that.
void MoveEntries(const fs::path& ready, const fs::path& folder) {
  const fs::path former = ready.parent_path() / "former";
  fs::create_directory(former);
  std::vector<fs::path> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(ready)) {
    names.push_back(entry.path().filename());
  }
  for (const fs::path& name : names) {
    const bool is_folder = fs::is_directory(fs::symlink_status(ready / name));
    const fs::file_status target = fs::symlink_status(folder / name);
    if (fs::is_directory(target) || (is_folder && fs::exists(target))) {
      fs::rename(folder / name, former / name);
    }
    fs::rename(ready / name, folder / name);
  }
}

// Ends the exports of processes that were killed while they moved their entries, and removes the
// files of those that were killed before.
void CleanUp(const fs::path& folder) {
  for (StagingFolder& abandoned : StagingFolder::Abandoned(folder, kStagingPrefix)) {
    const fs::path ready = abandoned.path() / kReady;
    if (fs::is_directory(fs::symlink_status(ready))) {
      abandoned.Keep();  // if an entry cannot be moved, the others stay where they are
      MoveEntries(ready, folder);
      abandoned.Remove();
    }
  }
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
    const FolderLock lock(path_);
    CleanUp(path_);
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
    const FolderLock lock(path_);
    const fs::path ready = staging_->path() / kReady;
    fs::rename(staging_->content(), ready);
    staging_->Keep();
    MoveEntries(ready, path_);
    staging_->Remove();
  } catch (const fs::filesystem_error& error) {
    FailOn(path_, error);
  }
}

}  // namespace hullslam
