// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "exports/export_formats.h"
#include "exports/export_input.h"

namespace hullslam {

struct FinishedExport {
  std::string content;             // a text about what was written
  std::vector<std::string> notes;  // what is missing
};

// Writes a finished run or a saved map in a format of ExportFormats(). Throws InputError for an
// unknown format, if something cannot be read or written, and unless `force` if the output exists.
FinishedExport ExportRun(const ExportSource& source, const std::string& format,
                         const ExportOptions& options, bool force = false);

}  // namespace hullslam
