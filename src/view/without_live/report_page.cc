// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/report_page.h"

#include "util/components.h"

namespace hullslam {

std::string FormatPage(std::string_view) {
  RequireComponent("LIVE", "a report is asked for");
  return {};
}

std::string FormatReport(const ViewModel&) { return FormatPage({}); }

}  // namespace hullslam
