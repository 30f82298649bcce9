// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "files/read_file.h"

namespace hullslam {

constexpr size_t kMostLineBytes = 1'000'000;  // limit for a line of a text file

// Parses `text` as a finite number. Returns false unless the whole text is one.
bool ParseFinite(std::string_view text, double& value);

// Parses `text` as finite numbers with separators of columns between them, as many as `values` has.
// Returns false for anything else.
bool ParseFinites(std::string_view text, Eigen::Ref<Eigen::VectorXd> values);

// One line of a text file, split into columns. The views are only valid during the visit.
struct TextRow {
  const std::filesystem::path& path;
  int line = 0;  // from 1
  std::vector<std::string_view> columns;
  // The last comment before the first line with data, or the line with the names of the columns.
  std::string_view header = {};

  // Throws InputError "FILE:LINE: what".
  [[noreturn]] void Fail(const std::string& what) const;
  // The finite number in a column; throws InputError with its `name` for anything else.
  double Number(size_t column, std::string_view name) const;
  // The same for a number from -most to most.
  double Number(size_t column, std::string_view name, double most) const;
  // The unit quaternion in four columns named qw, qx, qy and qz. Throws InputError unless its
  // length is about 1.
  Eigen::Quaterniond Rotation(size_t w, size_t x, size_t y, size_t z) const;
  // A time stamp, s.
  double Stamp(size_t column, std::string_view name = "timestamp") const;
};

// Visits the lines with data in order, of a file in any of the forms of ReadText(). Columns are
// separated by blanks, tabs, commas or semicolons. Empty lines and lines that start with '#' or '%'
// are skipped, and so is a first line with several names and no number, which names the columns of
// the lines that follow.
// Throws InputError for a file that ReadText() refuses, for a line of more than kMostLineBytes or
// with a byte 0, which would cut messages, and for semicolons between numbers with decimal
// commas.
void ForEachRow(const std::filesystem::path& path,
                const std::function<void(const TextRow& row)>& visit,
                size_t most_bytes = kMostTextFileBytes);

}  // namespace hullslam
