// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/synced_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "hullslam/util/error.h"

namespace hullslam {

bool WriteAll(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written >= 0) {
      content.remove_prefix(static_cast<size_t>(written));
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

void FailWriting(const std::filesystem::path& path, int code) {
  throw InputError(path.string() + ": cannot be written: " + std::generic_category().message(code));
}

void WriteSyncedFile(const std::filesystem::path& path, std::string_view content,
                     const std::filesystem::path& shown) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    FailWriting(shown, errno);
  }
  int failure = WriteAll(descriptor, content) && ::fsync(descriptor) == 0 ? 0 : errno;
  if (::close(descriptor) != 0 && failure == 0) {
    failure = errno;
  }
  if (failure != 0) {
    ::unlink(path.c_str());
    FailWriting(shown, failure);
  }
}

}  // namespace hullslam
