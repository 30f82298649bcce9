// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <system_error>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void FailReading(const fs::path& path, int code) {
  throw InputError(path.string() + ": " + std::generic_category().message(code));
}

[[noreturn]] void FailSize(const fs::path& path, const std::string& size, size_t most_bytes) {
  throw InputError(fmt::format("{}: {} bytes, expected at most {:g} MB", path.string(), size,
                               static_cast<double>(most_bytes) / 1e6));
}

class OpenedFile {
 public:
  // O_NONBLOCK: opening a FIFO that no program writes to would wait for ever.
  explicit OpenedFile(const fs::path& path)
      : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (descriptor_ < 0 && errno == ENXIO) {
      FailKind();  // a socket
    }
    if (descriptor_ < 0) {
      FailReading(path_, errno);
    }
  }
  ~OpenedFile() { ::close(descriptor_); }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  // The status of a regular file or of a pipe.
  struct stat Status() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) {
      FailReading(path_, errno);
    }
    if (S_ISDIR(status.st_mode)) {
      throw InputError(path_.string() + ": is a folder, expected a file");
    }
    if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) {
      FailKind();
    }
    return status;
  }

  // Reads some bytes. Returns 0 at the end of the file.
  size_t Read(char* bytes, size_t count) const {
    while (true) {
      const ssize_t read = ::read(descriptor_, bytes, count);
      if (read >= 0) {
        return static_cast<size_t>(read);
      }
      if (errno != EINTR) {
        FailReading(path_, errno);
      }
    }
  }

  // Waits until Read() gives bytes, or 0 because all writers have closed the pipe.
  void WaitForBytes(std::chrono::milliseconds patience) const {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + patience;
    while (true) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
      pollfd wait{.fd = descriptor_, .events = POLLIN, .revents = 0};
      const int ready = ::poll(&wait, 1, static_cast<int>(std::max<int64_t>(left, 0)));
      if (ready > 0) {
        return;
      }
      if (ready < 0 && errno != EINTR) {
        FailReading(path_, errno);
      }
      if (ready == 0) {
        throw InputError(fmt::format("{}: is a pipe, and nothing was written to it for {:g} s",
                                     path_.string(), static_cast<double>(patience.count()) / 1e3));
      }
    }
  }

 private:
  [[noreturn]] void FailKind() const {
    throw InputError(path_.string() + ": is neither a file nor a pipe");
  }

  const fs::path& path_;
  int descriptor_;
};

}  // namespace

std::string ReadFile(const fs::path& path, size_t most_bytes, std::chrono::milliseconds patience) {
  constexpr size_t kBlock = 1 << 16;
  const OpenedFile file(path);
  const struct stat status = file.Status();
  const bool is_pipe = S_ISFIFO(status.st_mode);
  const size_t size = is_pipe ? 0 : static_cast<size_t>(status.st_size);
  if (size > most_bytes) {
    FailSize(path, std::to_string(size), most_bytes);
  }
  std::string bytes(size, '\0');
  for (size_t filled = 0; filled < size;) {
    const size_t read = file.Read(bytes.data() + filled, size - filled);
    if (read == 0) {
      bytes.resize(filled);
      return bytes;
    }
    filled += read;
  }
  // The size is not known in advance for a pipe, and it is 0 for the files in /proc.
  std::string block(kBlock, '\0');  // not on the stack, which may be small in a thread
  while (true) {
    if (is_pipe) {
      file.WaitForBytes(patience);
    }
    const size_t read = file.Read(block.data(), block.size());
    if (read == 0) {
      return bytes;
    }
    if (read > most_bytes - bytes.size()) {
      FailSize(path, "more than " + std::to_string(most_bytes), most_bytes);
    }
    bytes.append(block.data(), read);
  }
}

void CheckFileSize(const fs::path& path, size_t most_bytes) {
  std::error_code error;
  const uintmax_t size = fs::file_size(path, error);
  if (!error && size > most_bytes) {
    FailSize(path, std::to_string(size), most_bytes);
  }
}

}  // namespace hullslam
