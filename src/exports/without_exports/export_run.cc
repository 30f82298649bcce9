// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_run.h"

#include "util/components.h"

namespace hullslam {

FinishedExport ExportRun(const ExportSource& source, const std::string& /*format*/,
                         const ExportOptions& /*options*/, bool /*force*/) {
  RequireComponent("EXPORTS", source.input.string() + " is to be exported");
  return {};
}

}  // namespace hullslam
