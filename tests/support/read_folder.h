// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "files/read_file.h"

namespace hullslam {

// The bytes of all files of a folder, by name, including hidden and temporary ones. A folder in it has
// the text "folder".
inline std::map<std::string, std::string> ReadFolder(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder)) {
    files[entry.path().filename()] = entry.is_directory() ? "folder" : ReadFile(entry.path());
  }
  return files;
}

}  // namespace hullslam
