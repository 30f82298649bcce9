// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_run.h"

#include <fmt/format.h>

#include "exports/export_folder.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {

FinishedExport ExportRun(const ExportSource& source, const std::string& format,
                         const ExportOptions& options, bool force) {
  std::string known;
  for (const ExportFormat& candidate : ExportFormats()) {
    if (format == candidate.name) {
      ExportInput input = ReadExportInput(source, candidate.need);
      CheckExportPath(options.output, input.read, force);
      std::string content = candidate.write(options, input);
      return {.content = std::move(content), .notes = std::move(input.notes)};
    }
    known += (known.empty() ? "" : ", ") + std::string(candidate.name);
  }
  throw InputError(fmt::format("the format is '{}', expected one of: {}", ShowText(format), known));
}

}  // namespace hullslam
