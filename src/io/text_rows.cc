// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// find_first_of() is not used: it calls memchr() for each character, which takes a tenth of the
// time of reading the masks of a frame.
bool IsSeparator(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == '\v' || c == '\f';
}

void SplitColumns(std::string_view line, std::vector<std::string_view>& columns) {
  columns.clear();
  const auto* begin = std::find_if_not(line.begin(), line.end(), IsSeparator);
  while (begin != line.end()) {
    const auto* end = std::find_if(begin, line.end(), IsSeparator);
    columns.emplace_back(begin, end);
    begin = std::find_if_not(end, line.end(), IsSeparator);
  }
}

// A text as shown in messages: it may be long or binary, so it is cut and cleaned.
std::string Printable(std::string_view text) {
  constexpr size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > kLongest ? shown + "..." : shown;
}

}  // namespace

std::string ReadFile(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(path.string() + ": is a folder, expected a file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path.string() + ": " + std::generic_category().message(errno));
  }
  std::string bytes;
  const uintmax_t size = std::filesystem::file_size(path, error);
  bytes.resize(error ? 0 : size);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(file.gcount());
  if (file.bad()) {
    throw InputError(path.string() + ": cannot be read");
  }
  return bytes;
}

void CheckFileSize(const std::filesystem::path& path, size_t most_bytes) {
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > most_bytes) {
    throw InputError(fmt::format("{}: {} bytes, expected at most {} MB", path.string(), size,
                                 most_bytes / 1'000'000));
  }
}

bool ParseFinite(std::string_view text, double& value) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

void TextRow::Fail(const std::string& what) const {
  throw InputError(path.string() + ':' + std::to_string(line) + ": " + what);
}

double TextRow::Number(size_t column, std::string_view name) const {
  double value = 0.0;
  if (!ParseFinite(columns.at(column), value)) {
    Fail(std::string(name) + " is '" + Printable(columns[column]) + "', expected a finite number");
  }
  return value;
}

void ForEachRow(const std::filesystem::path& path,
                const std::function<void(const TextRow& row)>& visit) {
  const std::string bytes = ReadFile(path);
  const std::string_view text = bytes;
  TextRow row{.path = path, .line = 0, .columns = {}};
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    ++row.line;
    SplitColumns(text.substr(begin, end - begin), row.columns);
    if (!row.columns.empty() && !row.columns[0].starts_with('#')) {
      visit(row);
    }
    begin = end + 1;
  }
}

}  // namespace hullslam
