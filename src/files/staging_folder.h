// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hullslam {

// A new folder for files that are not finished yet. Its name is unique, and a locked file in it
// tells other processes, also those in other containers, that its owner is alive. The destructor
// removes the folder with everything in it.
class StagingFolder {
 public:
  // Creates a folder in `parent` whose name is `prefix` and six random characters. Throws
  // std::filesystem::filesystem_error.
  StagingFolder(const std::filesystem::path& parent, const std::string& prefix);
  ~StagingFolder();
  StagingFolder(StagingFolder&& other) noexcept;
  StagingFolder& operator=(StagingFolder&&) = delete;

  // Takes over the staging folders in `parent` with this prefix whose owners have died without
  // removing them. Folders whose owner is alive are left alone.
  static std::vector<StagingFolder> Abandoned(const std::filesystem::path& parent,
                                              const std::string& prefix);

  const std::filesystem::path& path() const { return path_; }
  // The folder for the files. It has the permissions of an ordinary new folder, so it may be
  // renamed when it is finished.
  std::filesystem::path content() const { return path_ / "content"; }
  // After this call the destructor does not remove the folder.
  void Keep() { is_kept_ = true; }
  // Removes the folder now.
  void Remove();

 private:
  StagingFolder(std::filesystem::path path, int lock);

  std::filesystem::path path_;
  int lock_ = -1;  // descriptor of the locked file; -1 after a move
  bool is_kept_ = false;
};

// While it exists, other processes wait when they want to lock the same folder. On a file system
// without locks it has no effect.
class FolderLock {
 public:
  // Throws std::filesystem::filesystem_error if the folder cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace hullslam
