// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// All bytes of a file. Throws InputError, with the file's name and the reason, where it is missing,
// a folder or cannot be read.
std::string ReadFile(const std::filesystem::path& path);

// The finite number that `text` spells from its first to its last character; false otherwise.
bool ParseFinite(std::string_view text, double& value);

// One line of a text file with its columns. The views end with the visit.
struct TextRow {
  const std::filesystem::path& path;
  int line = 0;  // from 1
  std::vector<std::string_view> columns;

  // Throws InputError "FILE:LINE: what".
  [[noreturn]] void Fail(const std::string& what) const;
  // The finite number in a column; throws InputError, with its `name`, for anything else.
  double Number(size_t column, std::string_view name) const;
};

// Visits the lines that hold data in order. Columns are separated by blanks, tabs or commas; empty
// lines and those that start with '#' are passed over; CRLF ends are fine.
void ForEachRow(const std::filesystem::path& path,
                const std::function<void(const TextRow& row)>& visit);

}  // namespace hullslam
