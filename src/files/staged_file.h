// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
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

// Throws InputError: "PATH: cannot be written: REASON", with the system's text for this error code.
[[noreturn]] void FailWriting(const std::filesystem::path& path, int code);

// Writes all bytes to an open file. Returns false with the reason in errno if the system refuses.
bool WriteAll(int descriptor, std::string_view content);

// Writes a new file and waits until the disk has it, because some disks only then report that they
// are full. If this fails, removes the file and throws InputError like FailWriting(), with the path
// `shown` in the message.
void WriteSyncedFile(const std::filesystem::path& path, std::string_view content,
                     const std::filesystem::path& shown);

// A file that is written piece by piece and then gets its path as a whole. Until then it is in a
// temporary folder beside its path, and an earlier file at the path is unchanged. If the path is a
// link, all this refers to the file that the link leads to; the link stays. What killed processes
// have left of such a folder is removed by the next one that writes the same path.
class StagedFile {
 public:
  // All functions throw InputError with `path` and the reason of the system if they fail (disk
  // full, folder missing or not writable).
  explicit StagedFile(std::filesystem::path path);
  // Removes the temporary folder.
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  void Write(std::string_view bytes);
  // Waits until the disk has everything, because some disks only then report that they are full,
  // replaces the earlier file, and waits for that. To be called once, after the last Write.
  void Commit();

 private:
  std::filesystem::path temporary() const;

  std::filesystem::path path_;
  std::unique_ptr<StagingFolder> staging_;
  int descriptor_ = -1;
};

// Writes `content` to `path` so that the file is either complete or not there at all: it is written
// and synced in a temporary folder beside it, and then renamed. Throws InputError with `path` and
// the reason of the system if this fails (disk full, folder missing or not writable). Then an
// earlier file at `path` is unchanged. A link is followed. The files of a run are written together:
// see OutputFolder.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

// Throws InputError if WriteFileAtomically() could not write a small file at `path` now. Changes
// nothing there.
void ProbeFile(const std::filesystem::path& path);

}  // namespace hullslam
