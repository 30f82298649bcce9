// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <utility>

#include "files/read_file.h"

namespace hullslam {
namespace {

// A file descriptor, or -1.
class FileDescriptor {
 public:
  explicit FileDescriptor(const std::filesystem::path& path)
      : number_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~FileDescriptor() {
    if (number_ >= 0) {
      ::close(number_);
    }
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  int number() const { return number_; }

  // The size of a regular file that can be mapped; 0 for anything else.
  size_t MappableSize() const {
    struct stat status {};
    const bool is_file = number_ >= 0 && ::fstat(number_, &status) == 0 && S_ISREG(status.st_mode);
    return is_file ? static_cast<size_t>(status.st_size) : 0;
  }

 private:
  int number_;
};

FileBytes ReadCopy(const std::filesystem::path& path, size_t most_bytes) {
  auto content = std::make_shared<const std::string>(ReadFile(path, most_bytes));
  return {std::as_bytes(std::span(*content)), std::move(content)};
}

}  // namespace

FileBytes MapFile(const std::filesystem::path& path, size_t most_bytes) {
  const FileDescriptor file(path);
  const size_t size = file.MappableSize();
  if (size == 0 || size > most_bytes) {
    return ReadCopy(path, most_bytes);  // also reports what is wrong
  }
  void* const memory =
      ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file.number(), 0);
  if (memory == MAP_FAILED) {
    return ReadCopy(path, most_bytes);  // some file systems cannot map
  }
  return {{static_cast<const std::byte*>(memory), size},
          {memory, [size](void* mapped) { ::munmap(mapped, size); }}};
}

}  // namespace hullslam
