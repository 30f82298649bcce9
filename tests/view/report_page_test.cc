// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/report_page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "support/made_view.h"
#include "view/view_message.h"

namespace hullslam {
namespace {

TEST(ReportPage, IsOneSmallFileWithoutAddresses) {
  const std::string page = FormatPage({});
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_LT(page.size(), 1'500'000u);
  for (const char* const foreign : {"src=\"http", "href=\"http", "@import", "@DATA@"}) {
    EXPECT_EQ(page.find(foreign), std::string::npos) << foreign;
  }
}

TEST(ReportPage, TheDataAreInTheirElement) {
  const std::string report = FormatReport(MadeView(2, "</script>"));
  const std::string begin = "id=\"hullslam-data\">";
  const size_t at = report.find(begin) + begin.size();
  const std::string message = report.substr(at, report.find("</script>", at) - at);
  EXPECT_EQ(message, FormatViewMessage(MadeView(2, "</script>")));
  EXPECT_EQ(nlohmann::json::parse(message)["set"]["objects"][0]["class"], "</script>");
}

TEST(PageTemplate, HasOnePlaceForTheData) {
  const std::string_view page = PageTemplate();
  const size_t at = page.find("@DATA@");
  ASSERT_NE(at, std::string_view::npos);
  EXPECT_EQ(page.find("@DATA@", at + 1), std::string_view::npos);
  EXPECT_TRUE(page.ends_with("</html>\n"));
}

}  // namespace

}  // namespace hullslam
