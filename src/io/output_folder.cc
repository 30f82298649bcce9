// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/output_folder.h"

#include <system_error>

#include "hullslam/io/atomic_file.h"
#include "hullslam/util/error.h"

namespace hullslam {

void PrepareOutputFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error)) {
    throw InputError(folder.string() + ": cannot be used as output folder: " +
                     (error ? error.message() : "it is a file"));
  }
  const std::filesystem::path probe = folder / ".hullslam_probe";
  WriteFileAtomically(probe, "probe");
  std::filesystem::remove(probe, error);
}

}  // namespace hullslam
