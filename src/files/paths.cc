// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/paths.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <compare>
#include <string>
#include <system_error>
#include <vector>

#include "hullslam/util/error.h"

namespace hullslam {
namespace fs = std::filesystem;

fs::path CanonicalPath(const fs::path& path) {
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) {
    canonical = fs::absolute(path, error).lexically_normal();
  }
  // A path that ends in a slash has an empty last part.
  return canonical.has_filename() ? canonical : canonical.parent_path();
}

std::string CanonicalName(const std::filesystem::path& path) {
  return CanonicalPath(path).filename().string();
}

bool IsSameOrInside(const fs::path& path, const fs::path& outer) {
  const fs::path inside = CanonicalPath(path);
  const fs::path around = CanonicalPath(outer);
  return std::mismatch(around.begin(), around.end(), inside.begin(), inside.end()).first ==
         around.end();
}

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

namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Removes the digits at the beginning of the text, of which there is at least one, and returns them
// without leading zeros.
std::string_view TakeNumber(std::string_view& text) {
  const auto count =
      static_cast<size_t>(std::find_if_not(text.begin(), text.end(), IsDigit) - text.begin());
  std::string_view number = text.substr(0, count);
  text.remove_prefix(count);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

// The order of the first number or character of both, which are removed.
std::strong_ordering CompareFirst(std::string_view& a, std::string_view& b) {
  if (IsDigit(a[0]) && IsDigit(b[0])) {
    const std::string_view x = TakeNumber(a);
    const std::string_view y = TakeNumber(b);
    return x.size() != y.size() ? x.size() <=> y.size() : x <=> y;
  }
  const auto order = static_cast<unsigned char>(a[0]) <=> static_cast<unsigned char>(b[0]);
  a.remove_prefix(1);
  b.remove_prefix(1);
  return order;
}

}  // namespace

bool IsNaturallyBefore(std::string_view a, std::string_view b) {
  std::string_view rest_of_a = a;
  std::string_view rest_of_b = b;
  while (!rest_of_a.empty() && !rest_of_b.empty()) {
    const std::strong_ordering order = CompareFirst(rest_of_a, rest_of_b);
    if (order != 0) {
      return order < 0;
    }
  }
  if (rest_of_a.empty() != rest_of_b.empty()) {
    return rest_of_a.empty();
  }
  return a < b;
}

}  // namespace hullslam
