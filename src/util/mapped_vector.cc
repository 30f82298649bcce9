// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/mapped_vector.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

namespace hullslam {
namespace {

size_t PageSize() {
  static const auto size = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

// A file that has no name any more, so it is gone when it is closed, however the program ends;
// -1 if none can be made.
int OpenTemporaryFile() {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "hullslam-XXXXXX").string();
  if (error) {
    return -1;
  }
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) {
    unlink(name.c_str());
  }
  return file;
}

}  // namespace

MappedMemory& MappedMemory::operator=(MappedMemory&& other) noexcept {
  Clear();
  std::swap(file_, other.file_);
  std::swap(is_without_file_, other.is_without_file_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(given_back_, other.given_back_);
  return *this;
}

void MappedMemory::Grow(size_t bytes) {
  const size_t size = (bytes + PageSize() - 1) / PageSize() * PageSize();
  if (size <= size_) {
    return;
  }
  if (is_without_file_ || !GrowFile(size)) {
    GrowWithoutFile(size);
  }
}

bool MappedMemory::GrowFile(size_t bytes) {
  if (file_ < 0) {
    file_ = OpenTemporaryFile();
  }
  // The blocks of the file are reserved, because a page that finds no room on the disk later would
  // end the program.
  const auto begin = static_cast<off_t>(size_);
  if (file_ < 0 || posix_fallocate(file_, begin, static_cast<off_t>(bytes) - begin) != 0) {
    return false;
  }
  void* const data = data_ == nullptr
                         ? mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0)
                         : mremap(data_, size_, bytes, MREMAP_MAYMOVE);
  if (data == MAP_FAILED) {
    return false;
  }
  data_ = data;
  size_ = bytes;
  return true;
}

void MappedMemory::GrowWithoutFile(size_t bytes) {
  void* const data =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED) {
    throw std::bad_alloc();
  }
  if (size_ > 0) {
    std::memcpy(data, data_, size_);
  }
  Clear();
  is_without_file_ = true;
  data_ = data;
  size_ = bytes;
}

void MappedMemory::GiveBack(size_t bytes) {
  const size_t whole = bytes / PageSize() * PageSize();
  if (file_ < 0 || whole == 0) {
    return;
  }
  given_back_ = given_back_ < whole ? given_back_ : 0;
  for (const size_t begin : {whole - std::min(whole, kMostGivenBack), given_back_}) {
    // Of a shared file: the content stays in the file.
    madvise(static_cast<std::byte*>(data_) + begin, std::min(whole - begin, kMostGivenBack),
            MADV_DONTNEED);
  }
  given_back_ += kMostGivenBack;
}

void MappedMemory::Clear() {
  if (data_ != nullptr) {
    munmap(data_, size_);
  }
  if (file_ >= 0) {
    close(file_);
  }
  file_ = -1;
  is_without_file_ = false;
  data_ = nullptr;
  size_ = 0;
  given_back_ = 0;
}

}  // namespace hullslam
