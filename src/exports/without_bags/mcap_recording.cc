// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/mcap_recording.h"

#include "util/components.h"

namespace hullslam {

size_t WriteRecording(const std::filesystem::path& file, const RecordedRun&) {
  RequireComponent("BAGS", file.string() + " is a recording");
  return 0;
}

}  // namespace hullslam
