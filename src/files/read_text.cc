// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
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
