// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/canonical_path.h"

#include <algorithm>
#include <system_error>

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

}  // namespace hullslam
