// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/page_template.h"

#include <gtest/gtest.h>

#include <string_view>

namespace hullslam {
namespace {

TEST(PageTemplate, HasOnePlaceForTheData) {
  const std::string_view page = PageTemplate();
  const size_t at = page.find("@DATA@");
  ASSERT_NE(at, std::string_view::npos);
  EXPECT_EQ(page.find("@DATA@", at + 1), std::string_view::npos);
  EXPECT_TRUE(page.ends_with("</html>\n"));
}

}  // namespace
}  // namespace hullslam
