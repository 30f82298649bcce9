// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/text_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "files/plausible.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

// find_first_of() is not used: it calls memchr() for each character, which takes a tenth of the
// time of reading the masks of a frame.
bool IsSeparator(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';' || c == '\v' || c == '\f';
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

// Whether the text begins with a number, as "12px" and "nan" do.
bool BeginsWithNumber(std::string_view text) {
  double value = 0.0;
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  return std::from_chars(text.data(), text.data() + text.size(), value).ec !=
         std::errc::invalid_argument;
}

bool NamesColumns(const std::vector<std::string_view>& columns) {
  return columns.size() > 1 && std::none_of(columns.begin(), columns.end(), BeginsWithNumber);
}

// Spreadsheets of many countries write "0,5;1,5" for the numbers 0.5 and 1.5. As commas separate
// columns here, such a line would have twice as many numbers.
bool HasDecimalCommas(std::string_view line) {
  return line.find(';') != std::string_view::npos && line.find(',') != std::string_view::npos &&
         line.find('.') == std::string_view::npos;
}

bool IsComment(const std::vector<std::string_view>& columns) {
  return !columns.empty() && (columns[0].starts_with('#') || columns[0].starts_with('%'));
}

// Refuses lines that cannot be split, or that would be split wrongly.
void CheckLine(const TextRow& row, std::string_view line) {
  if (line.size() > kMostLineBytes) {
    row.Fail(fmt::format("a line of {} bytes, expected at most {} MB", line.size(),
                         kMostLineBytes / 1'000'000));
  }
  if (line.find('\0') != std::string_view::npos) {
    row.Fail("has a byte that is 0, expected text");
  }
}

std::string Shown(std::string_view column) {
  constexpr size_t kLongest = 40;
  return ShowText(column, kLongest);
}

}  // namespace

bool ParseFinite(std::string_view text, double& value) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

bool ParseFinites(std::string_view text, Eigen::Ref<Eigen::VectorXd> values) {
  std::vector<std::string_view> columns;
  SplitColumns(text, columns);
  bool are_finite = columns.size() == static_cast<size_t>(values.size());
  for (size_t i = 0; are_finite && i < columns.size(); ++i) {
    are_finite = ParseFinite(columns[i], values[static_cast<Eigen::Index>(i)]);
  }
  return are_finite;
}

void TextRow::Fail(const std::string& what) const {
  throw InputError(path.string() + ':' + std::to_string(line) + ": " + what);
}

double TextRow::Number(size_t column, std::string_view name) const {
  double value = 0.0;
  if (!ParseFinite(columns.at(column), value)) {
    Fail(fmt::format("{} is '{}', expected a finite number", name, Shown(columns[column])));
  }
  return value;
}

double TextRow::Number(size_t column, std::string_view name, double most) const {
  const double value = Number(column, name);
  if (std::abs(value) > most) {
    Fail(fmt::format("{} is '{}', expected a number from {:g} to {:g}", name,
                     Shown(columns[column]), -most, most));
  }
  return value;
}

Eigen::Quaterniond TextRow::Rotation(size_t w, size_t x, size_t y, size_t z) const {
  // Read in separate statements, because C++ does not specify in which order the arguments of a
  // call are evaluated.
  const double qw = Number(w, "qw");
  const double qx = Number(x, "qx");
  const double qy = Number(y, "qy");
  const double qz = Number(z, "qz");
  const Eigen::Quaterniond rotation(qw, qx, qy, qz);
  if (!IsPlausibleRotation(rotation)) {
    Fail(fmt::format("the quaternion has length {:g}, expected a rotation (length 1)",
                     rotation.norm()));
  }
  return rotation.normalized();
}

double TextRow::Stamp(size_t column, std::string_view name) const {
  const double value = Number(column, name);
  if (std::abs(value) > kMostSeconds) {
    Fail(fmt::format("{} is '{}', expected a time in seconds, up to {:g}", name,
                     Shown(columns[column]), kMostSeconds));
  }
  return value;
}

void ForEachRow(const std::filesystem::path& path,
                const std::function<void(const TextRow& row)>& visit, size_t most_bytes) {
  const std::string text = ReadText(path, most_bytes);
  TextRow row{.path = path, .line = 0, .columns = {}};
  bool is_first = true;  // no line with data or with names has come yet
  int names = 0;         // the line with the names, until data follow; then 0
  for (const std::string_view line : LinesOf(text)) {
    ++row.line;
    CheckLine(row, line);
    SplitColumns(line, row.columns);
    const bool is_comment = IsComment(row.columns);
    if (!is_comment && HasDecimalCommas(line)) {
      row.Fail("has semicolons and decimal commas, expected numbers with decimal points");
    }
    if (is_first && (is_comment || NamesColumns(row.columns))) {
      row.header = line;
      names = is_comment ? 0 : row.line;
    } else if (!row.columns.empty() && !is_comment) {
      names = 0;
      visit(row);
    }
    is_first = is_first && (row.columns.empty() || is_comment);
  }
  // If no data follow, the line is not what it seems, and the visitor can say why.
  if (names != 0) {
    row.line = names;
    SplitColumns(row.header, row.columns);
    visit(row);
  }
}

}  // namespace hullslam
