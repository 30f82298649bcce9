// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "results/output_folder.h"

namespace hullslam {

class StagingFolder;

// Throws InputError if an export must not be written to this path: if it is an input, inside of one
// or contains one; or if it is a file, or a folder with files, and `force` is not set.
void CheckExportPath(const std::filesystem::path& path,
                     std::span<const std::filesystem::path> inputs, bool force);

// A folder that an export is written to. Its files are collected in a hidden folder inside of it
// and moved at the end, so an export that fails leaves nothing. An entry of the folder with the
// name of a new file or folder is replaced as a whole; other entries stay. Of several exports at
// once, the one that ends last leaves its files. If a process is killed while it moves its files,
// the next export to the folder moves the others first.
class ExportFolder {
 public:
  // `path` has passed CheckExportPath(). It is created if it does not exist. Throws InputError if
  // files cannot be written there.
  explicit ExportFolder(std::filesystem::path path);
  // Removes what was not committed.
  ~ExportFolder();
  ExportFolder(const ExportFolder&) = delete;
  ExportFolder& operator=(const ExportFolder&) = delete;

  // Writes a file whose name may contain folders, such as "images/1.png". Throws InputError if this
  // fails.
  void Write(const FileContent& file);
  // To be called once, after the last Write. Throws InputError if an entry cannot be moved.
  void Commit();

 private:
  std::filesystem::path path_;
  bool is_new_ = false;
  std::unique_ptr<StagingFolder> staging_;
};

}  // namespace hullslam
