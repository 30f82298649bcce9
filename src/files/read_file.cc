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
#include <utility>

#include "hullslam/util/error.h"
#include "util/text.h"

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

namespace {

namespace fs = std::filesystem;

enum class Encoding { kBytes, kUtf16LittleEndian, kUtf16BigEndian, kUtf32 };

struct Form {
  Encoding encoding = Encoding::kBytes;
  size_t mark = 0;  // bytes of the byte order mark
};

Form FindForm(std::string_view text) {
  using namespace std::string_view_literals;
  if (text.starts_with("\xff\xfe\0\0"sv) || text.starts_with("\0\0\xfe\xff"sv)) {
    return {Encoding::kUtf32, 4};
  }
  if (text.starts_with("\xef\xbb\xbf")) {
    return {Encoding::kBytes, 3};
  }
  if (text.starts_with("\xff\xfe")) {
    return {Encoding::kUtf16LittleEndian, 2};
  }
  if (text.starts_with("\xfe\xff")) {
    return {Encoding::kUtf16BigEndian, 2};
  }
  // Without a mark: the first two characters are in ASCII, as in all files that are read here.
  const auto is_zero = [&](size_t i) { return i < text.size() && text[i] == '\0'; };
  if (text.size() >= 4 && is_zero(1) && is_zero(3) && !is_zero(0) && !is_zero(2)) {
    return {Encoding::kUtf16LittleEndian, 0};
  }
  if (text.size() >= 4 && is_zero(0) && is_zero(2) && !is_zero(1) && !is_zero(3)) {
    return {Encoding::kUtf16BigEndian, 0};
  }
  return {};
}

void AppendUtf8(uint32_t character, std::string& text) {
  if (character < 0x80) {
    text += static_cast<char>(character);
    return;
  }
  const int following = character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;
  constexpr int kFirst[] = {0, 0xc0, 0xe0, 0xf0};  // by the number of bytes that follow
  text += static_cast<char>(kFirst[following] | (character >> (6 * following)));
  for (int i = following - 1; i >= 0; --i) {
    text += static_cast<char>(0x80 | ((character >> (6 * i)) & 0x3f));
  }
}

// Two units, 0xd800 + a and 0xdc00 + b with 10 bits each, are the character 0x10000 + 1024 a + b.
std::string FromUtf16(const fs::path& path, std::string_view bytes, bool is_little_endian) {
  const auto unit = [&](size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<uint32_t>(is_little_endian ? first | second << 8 : first << 8 | second);
  };
  const auto is_in = [](uint32_t value, uint32_t first) {
    return value >= first && value < first + 0x400;
  };
  std::string text;
  text.reserve(bytes.size());
  for (size_t i = 0; i < bytes.size(); i += 2) {
    uint32_t character = i + 1 < bytes.size() ? unit(i) : 0xdc00;
    if (is_in(character, 0xd800) && i + 3 < bytes.size() && is_in(unit(i + 2), 0xdc00)) {
      character = 0x10000 + ((character - 0xd800) << 10) + (unit(i + 2) - 0xdc00);
      i += 2;
    } else if (is_in(character, 0xd800) || is_in(character, 0xdc00)) {
      throw InputError(fmt::format("{}: is UTF-16 with half a character at byte {}, expected text",
                                   path.string(), i));
    }
    AppendUtf8(character, text);
  }
  return text;
}

}  // namespace

std::string ReadText(const fs::path& path, size_t most_bytes) {
  std::string bytes = ReadFile(path, most_bytes);
  const Form form = FindForm(bytes);
  if (form.encoding == Encoding::kUtf32) {
    throw InputError(path.string() + ": is text in UTF-32, expected UTF-8 or UTF-16");
  }
  std::string text = form.encoding == Encoding::kBytes && form.mark == 0 ? std::move(bytes)
                     : form.encoding == Encoding::kBytes
                         ? bytes.substr(form.mark)
                         : FromUtf16(path, std::string_view(bytes).substr(form.mark),
                                     form.encoding == Encoding::kUtf16LittleEndian);
  if (text.find('\n') == std::string::npos) {
    std::replace(text.begin(), text.end(), '\r', '\n');
  }
  return text;
}

std::vector<std::string_view> LinesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

void CheckUtf8(const fs::path& path, std::string_view text) {
  int number = 0;
  for (const std::string_view line : LinesOf(text)) {
    ++number;
    if (!IsUtf8(line)) {
      throw InputError(
          fmt::format("{}:{}: '{}' is not UTF-8 (perhaps an 8-bit encoding of Windows), expected a "
                      "file that is "
                      "saved as UTF-8",
                      path.string(), number, ShowText(line)));
    }
  }
}

}  // namespace hullslam
