// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/report_page.h"

#include "hullslam/util/check.h"
#include "view/view_message.h"

namespace hullslam {

std::string FormatPage(std::string_view message) {
  constexpr std::string_view kMark = "@DATA@";
  const std::string_view page = PageTemplate();
  const size_t at = page.find(kMark);
  Check(at != std::string_view::npos, "the page has a place for its data");
  std::string text(page.substr(0, at));
  text += message;
  text += page.substr(at + kMark.size());
  return text;
}

std::string FormatReport(const ViewModel& model) { return FormatPage(FormatViewMessage(model)); }

}  // namespace hullslam
