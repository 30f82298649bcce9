// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/atomic_file.h"

#include "files/staged_file.h"

namespace hullslam {

void WriteFileAtomically(const std::filesystem::path& path, std::string_view content) {
  StagedFile file(path);
  file.Write(content);
  file.Commit();
}

void ProbeFile(const std::filesystem::path& path) { StagedFile(path).Write("probe"); }

}  // namespace hullslam
