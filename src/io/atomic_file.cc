// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <deque>
#include <string>
#include <system_error>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

[[noreturn]] void FailWriting(const std::filesystem::path& path, int code) {
  throw InputError(path.string() + ": cannot be written: " + std::generic_category().message(code));
}

// A new file that is removed in the destructor unless it was renamed to its target.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target)
      : target_(target), path_(target.string() + '.' + std::to_string(::getpid()) + ".tmp") {
    ::unlink(path_.c_str());  // left behind by a killed process with the same number
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      FailWriting(target_, errno);
    }
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    if (!renamed_) {
      ::unlink(path_.c_str());
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void Write(std::string_view content) {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written >= 0) {
        content.remove_prefix(written);
      } else if (errno != EINTR) {
        FailWriting(target_, errno);
      }
    }
  }

  // Call after the last Write().
  void Finish() {
    // Some disks only report that they are full when the data is really written.
    if (::fsync(descriptor_) != 0) {
      FailWriting(target_, errno);
    }
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) {
      FailWriting(target_, errno);
    }
  }

  // Call after Finish().
  void Publish() {
    if (::rename(path_.c_str(), target_.c_str()) != 0) {
      FailWriting(target_, errno);
    }
    renamed_ = true;
  }

 private:
  std::filesystem::path target_;
  std::string path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

void CheckTarget(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    // Renaming would replace a device or a pipe by a file.
    throw InputError(path.string() + ": cannot be written: it is not a regular file");
  }
}

}  // namespace

void WriteFileAtomically(const std::filesystem::path& path, std::string_view content) {
  CheckTarget(path);
  TemporaryFile file(path);
  file.Write(content);
  file.Finish();
  file.Publish();
}

void WriteFilesAtomically(std::span<const FileContent> files) {
  for (const FileContent& file : files) {
    CheckTarget(file.path);
  }
  std::deque<TemporaryFile> written;
  for (const FileContent& file : files) {
    TemporaryFile& temporary = written.emplace_back(file.path);
    temporary.Write(file.content);
    temporary.Finish();
  }
  for (TemporaryFile& temporary : written) {
    temporary.Publish();
  }
}

}  // namespace hullslam
