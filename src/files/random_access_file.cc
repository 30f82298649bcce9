// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/random_access_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

[[noreturn]] void FailAccess(const std::filesystem::path& path, int code) {
  throw InputError(path.string() + ": " + std::generic_category().message(code));
}

}  // namespace

// O_NONBLOCK: opening a FIFO that no program writes to would wait for ever.
RandomAccessFile::RandomAccessFile(std::filesystem::path path)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    FailAccess(path_, errno);
  }
  struct stat status {};
  const int code = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
  if (code != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    if (code != 0) {
      FailAccess(path_, code);
    }
    throw InputError(path_.string() + ": is not a regular file");
  }
  size_ = static_cast<uint64_t>(status.st_size);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

std::string RandomAccessFile::Read(uint64_t offset, size_t count) const {
  if (offset >= size_) {
    return {};
  }
  std::string bytes(std::min<uint64_t>(count, size_ - offset), '\0');
  for (size_t filled = 0; filled < bytes.size();) {
    const ssize_t read = ::pread(descriptor_, bytes.data() + filled, bytes.size() - filled,
                                 static_cast<off_t>(offset + filled));
    if (read < 0 && errno != EINTR) {
      FailAccess(path_, errno);
    }
    if (read == 0) {
      bytes.resize(filled);
    }
    filled += static_cast<size_t>(std::max<ssize_t>(read, 0));
  }
  return bytes;
}

}  // namespace hullslam
