// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/class_names.h"

#include <fmt/format.h>

#include <cctype>
#include <map>

#include "files/read_text.h"
#include "hullslam/util/error.h"
#include "util/trim.h"

namespace hullslam {
namespace {

void SkipBlanks(std::string_view& text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) {
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

// A text in single or double quotes, in which a backslash keeps the next character.
std::optional<std::string> TakeQuoted(std::string_view& text) {
  SkipBlanks(text);
  const char quote = text.empty() ? '\0' : text.front();
  if (quote != '\'' && quote != '"') {
    return std::nullopt;
  }
  std::string name;
  for (size_t i = 1; i < text.size(); ++i) {
    if (text[i] == quote) {
      text.remove_prefix(i + 1);
      return name;
    }
    i += text[i] == '\\' ? 1 : 0;
    name += i < text.size() ? text[i] : '\\';
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<std::string>> ParseClassNames(std::string_view text) {
  std::vector<std::string> names;
  if (!Take('{', text)) {
    return std::nullopt;
  }
  while (!Take('}', text)) {
    const std::optional<size_t> number = TakeNumber(text);
    if (!number || *number != names.size() || !Take(':', text)) {
      return std::nullopt;
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

std::vector<std::string> ReadClassNames(const std::filesystem::path& path) {
  constexpr size_t kMostBytes = 1'000'000;
  const std::string text = ReadText(path, kMostBytes);
  CheckUtf8(path, text);
  std::vector<std::string> names;
  std::map<std::string, size_t> lines;
  std::string_view rest = text;
  rest = rest.substr(0, rest.find_last_not_of(" \t\r\n") + 1);  // empty lines at the end are none
  while (!rest.empty()) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    std::string name(Trim(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const size_t line = names.size() + 1;
    const auto [earlier, is_new] = lines.emplace(name, line);
    if (name.empty() || !is_new) {
      throw InputError(fmt::format(
          "{}:{}: {}, expected the name of class {}", path.string(), line,
          name.empty() ? "is empty" : fmt::format("'{}' is also in line {}", name, earlier->second),
          line - 1));
    }
    names.push_back(std::move(name));
  }
  if (names.empty()) {
    throw InputError(path.string() + ": has no names, expected one per line");
  }
  return names;
}

}  // namespace hullslam
