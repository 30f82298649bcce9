// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/data_path.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <system_error>
#include <vector>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

const fs::path kShare = fs::path("share") / "hullslam";

// The folder share/hullslam of the installation that this code is in; empty if it is not installed.
fs::path OwnShare() {
  std::error_code error;
  for (fs::path folder = FileOfThisCode().parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    if (fs::is_directory(folder / kShare, error)) {
      return folder / kShare;
    }
  }
  return {};
}

}  // namespace

fs::path FileOfThisCode() {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&FindData), &info) == 0 || info.dli_fname == nullptr) {
    return {};
  }
  const fs::path file = fs::canonical(info.dli_fname, error);
  // For a program, the name is how it was called, which need not be a path.
  return error ? fs::read_symlink("/proc/self/exe", error) : file;
}

fs::path FindData(const fs::path& name, std::string_view hint) {
  std::vector<std::string> paths;
  for (const fs::path& folder :
       {OwnShare(), fs::path(HULLSLAM_INSTALLED_DATA), fs::path(HULLSLAM_SOURCE_FOLDER)}) {
    std::error_code error;
    if (!folder.empty() && fs::exists(folder / name, error)) {
      return folder / name;
    }
    if (!folder.empty()) {
      paths.push_back((folder / name).string());
    }
  }
  throw InputError(fmt::format("none of {} exists; {}", fmt::join(paths, ", "), hint));
}

}  // namespace hullslam
