// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace hullslam {

// A regular file that is too large to be read as a whole, opened for reading at any position.
class RandomAccessFile {
 public:
  // Throws InputError with the name of the file and the reason if it cannot be opened or is no
  // regular file.
  explicit RandomAccessFile(std::filesystem::path path);
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  uint64_t size() const { return size_; }
  // The `count` bytes at `offset`; fewer at the end of the file, none behind it. Throws InputError
  // if the system cannot read them.
  std::string Read(uint64_t offset, size_t count) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  uint64_t size_ = 0;  // when it was opened
};

}  // namespace hullslam
