// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/class_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <map>
#include <utility>

#include "files/read_file.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

void SkipBlanks(std::string_view& text) {
  while (!text.empty() && IsBlank(text.front())) {
    text.remove_prefix(1);
  }
}

bool Take(char expected, std::string_view& text) {
  SkipBlanks(text);
  if (text.empty() || text.front() != expected) {
    return false;
  }
  text.remove_prefix(1);
  return true;
}

std::optional<size_t> TakeNumber(std::string_view& text) {
  constexpr size_t kMost = 1'000'000;
  SkipBlanks(text);
  std::optional<size_t> number;
  while (!text.empty() && text.front() >= '0' && text.front() <= '9' &&
         number.value_or(0) < kMost) {
    number = number.value_or(0) * 10 + static_cast<size_t>(text.front() - '0');
    text.remove_prefix(1);
  }
  return number;
}

void AppendUtf8(uint32_t character, std::string& text) {
  if (character < 0x80) {
    text += static_cast<char>(character);
    return;
  }
  const int following = character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;
  constexpr std::array<uint32_t, 4> kFirst = {0, 0xc0, 0xe0, 0xf0};  // by the bytes that follow
  text += static_cast<char>(kFirst.at(static_cast<size_t>(following)) | character >> 6 * following);
  for (int i = following - 1; i >= 0; --i) {
    text += static_cast<char>(0x80 | (character >> 6 * i & 0x3f));
  }
}

// Appends what a backslash and the characters after it stand for in Python and JSON. `text` begins
// behind the backslash.
void TakeEscaped(std::string_view& text, std::string& name) {
  const char kind = text.empty() ? '\\' : text.front();
  text.remove_prefix(text.empty() ? 0 : 1);
  const size_t digits = kind == 'x' ? 2 : kind == 'u' ? 4 : kind == 'U' ? 8 : 0;
  uint32_t character = 0;
  const char* const end = text.data() + std::min(digits, text.size());
  if (digits > 0 && std::from_chars(text.data(), end, character, 16).ptr == end &&
      character <= 0x10ffff) {
    AppendUtf8(character, name);
    text.remove_prefix(static_cast<size_t>(end - text.data()));
    return;
  }
  name += kind == 'n' ? '\n' : kind == 'r' ? '\r' : kind == 't' ? '\t' : kind;
}

// A text in single or double quotes.
std::optional<std::string> TakeQuoted(std::string_view& text) {
  SkipBlanks(text);
  const char quote = text.empty() ? '\0' : text.front();
  if (quote != '\'' && quote != '"') {
    return std::nullopt;
  }
  text.remove_prefix(1);
  std::string name;
  while (!text.empty()) {
    const char character = text.front();
    text.remove_prefix(1);
    if (character == quote) {
      return name;
    }
    if (character == '\\') {
      TakeEscaped(text, name);
    } else {
      name += character;
    }
  }
  return std::nullopt;
}

// The number of a class before its name, also in quotes.
std::optional<size_t> TakeKey(std::string_view& text) {
  if (std::optional<std::string> quoted = TakeQuoted(text)) {
    std::string_view digits = *quoted;
    const std::optional<size_t> number = TakeNumber(digits);
    return digits.empty() ? number : std::nullopt;
  }
  return TakeNumber(text);
}

// Throws unless the name may stand where it is. `place` begins the message, `earlier` tells
// where the names before are.
void AddName(const std::string& place, const std::string& here, std::string name,
             std::map<std::string, std::string>& earlier, std::vector<std::string>& names) {
  const auto fail = [&](const std::string& fault) {
    throw InputError(
        fmt::format("{}: {}, expected the name of class {}", place, fault, names.size()));
  };
  if (Trim(name).empty()) {
    fail("is empty");
  }
  constexpr const char* kByteOrderMark = "\xef\xbb\xbf";  // readers of the file take it away
  if (Trim(name) != name || Printable(name) != name || name.starts_with(kByteOrderMark)) {
    fail(fmt::format("'{}' has control characters, blanks around it, or is not UTF-8",
                     Printable(name)));
  }
  const auto [former, is_new] = earlier.emplace(name, here);
  if (!is_new) {
    fail(fmt::format("'{}' is also {}", name, former->second));
  }
  names.push_back(std::move(name));
}

}  // namespace

std::optional<std::vector<std::string>> ParseClassNames(std::string_view text) {
  std::vector<std::string> names;
  const bool is_list = Take('[', text);
  if (!is_list && !Take('{', text)) {
    return std::nullopt;
  }
  while (!Take(is_list ? ']' : '}', text)) {
    if (!is_list) {
      const std::optional<size_t> number = TakeKey(text);
      if (!number || *number != names.size() || !Take(':', text)) {
        return std::nullopt;
      }
    }
    std::optional<std::string> name = TakeQuoted(text);
    if (!name || name->empty()) {
      return std::nullopt;
    }
    names.push_back(std::move(*name));
    Take(',', text);
  }
  return names.empty() ? std::nullopt : std::optional(std::move(names));
}

void CheckClassNames(const std::string& source, const std::vector<std::string>& names) {
  std::vector<std::string> checked;
  std::map<std::string, std::string> earlier;
  for (const std::string& name : names) {
    AddName(source, fmt::format("that of class {}", checked.size()), name, earlier, checked);
  }
}

std::vector<std::string> ReadClassNames(const std::filesystem::path& path) {
  constexpr size_t kMostBytes = 1'000'000;
  std::string text = ReadText(path, kMostBytes);
  CheckUtf8(path, text);
  text.erase(text.find_last_not_of(" \t\r\n") + 1);  // empty lines at the end are none
  std::vector<std::string> names;
  std::map<std::string, std::string> earlier;
  for (const std::string_view line : LinesOf(text)) {
    const size_t number = names.size() + 1;
    AddName(fmt::format("{}:{}", path.string(), number), fmt::format("in line {}", number),
            std::string(Trim(line)), earlier, names);
  }
  if (names.empty()) {
    throw InputError(path.string() + ": has no names, expected one per line");
  }
  return names;
}

}  // namespace hullslam
