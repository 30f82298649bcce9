// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// All bytes of a file. Throws InputError with the name of the file and the reason if it is missing,
// is a folder, or cannot be read.
std::string ReadFile(const std::filesystem::path& path);

// Throws InputError if the file has more bytes. (If the size cannot be read, the error is left to
// the reader of the file.)
void CheckFileSize(const std::filesystem::path& path, size_t most_bytes);

// Parses `text` as a finite number. Returns false if it is none or if characters are left over.
bool ParseFinite(std::string_view text, double& value);

// One line of a text file, split into columns. The views are only valid during the visit.
struct TextRow {
  const std::filesystem::path& path;
  int line = 0;  // from 1
  std::vector<std::string_view> columns;

  // Throws InputError "FILE:LINE: what".
  [[noreturn]] void Fail(const std::string& what) const;
  // The finite number in a column; throws InputError with its `name` for anything else.
  double Number(size_t column, std::string_view name) const;
};

// Visits the lines with data in order. Columns are separated by blanks, tabs or commas. Empty lines
// and lines that start with '#' are skipped; CRLF line ends are accepted.
void ForEachRow(const std::filesystem::path& path,
                const std::function<void(const TextRow& row)>& visit);

}  // namespace hullslam
