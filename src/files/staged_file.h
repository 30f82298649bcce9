// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

namespace hullslam {

class StagingFolder;

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
  // and replaces the earlier file. To be called once, after the last Write.
  void Commit();

 private:
  std::filesystem::path temporary() const;

  std::filesystem::path path_;
  std::unique_ptr<StagingFolder> staging_;
  int descriptor_ = -1;
};

}  // namespace hullslam
